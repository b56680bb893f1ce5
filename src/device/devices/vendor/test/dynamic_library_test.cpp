#include "devices/vendor/dynamic_library.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/files/folders.h"
#include "core/testing/source_dir.h"

namespace trocar::devices {
namespace {
namespace fs = std::filesystem;

constexpr const char* kVariable = "TROCAR_LIBTEST";

/// The error of a library that the variable names; empty: it was loaded.
std::string load_error(const fs::path& library, std::chrono::milliseconds timeout = std::chrono::minutes(1)) {
  ::setenv(kVariable, library.c_str(), 1);
  const LibraryPlace place{
      .variable = kVariable, .names = {}, .package = "the test", .advice = "build it", .timeout = timeout};
  const auto loaded = DynamicLibrary::open(place);
  ::unsetenv(kVariable);
  return loaded ? std::string() : loaded.error().text();
}

TEST(DynamicLibrary, OnlyARegularFileIsOpened) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe.so").c_str(), 0600), 0);
  fs::create_symlink("pipe.so", folder / "link.so");
  fs::create_symlink("/dev/zero", folder / "zero.so");
  fs::create_directory(folder / "folder.so");
  for (const char* name : {"pipe.so", "link.so", "zero.so"})
    EXPECT_NE(load_error(folder / name).find("not a regular file"), std::string::npos) << load_error(folder / name);
  EXPECT_NE(load_error("/dev/zero").find("not a regular file"), std::string::npos);
  EXPECT_NE(load_error(folder / "folder.so").find("is a folder"), std::string::npos);
  EXPECT_NE(load_error(folder / "none.so").find("no such file"), std::string::npos);
}

TEST(DynamicLibrary, ReportsTheLoaderErrorForANonLibrary) {
  const TemporaryFolder folder;
  std::ofstream(folder / "text.so") << std::string(100'000, 'x');
  std::ofstream(folder / "empty.so");
  for (const char* name : {"text.so", "empty.so"}) {
    const std::string error = load_error(folder / name);
    EXPECT_NE(error.find("the test cannot be loaded"), std::string::npos) << error;
    EXPECT_NE(error.find(name), std::string::npos) << error;
  }
  EXPECT_NE(load_error("libtrocar_that_nobody_has.so").find("the test cannot be loaded"), std::string::npos);
}

TEST(DynamicLibrary, GivesUpOnALoadThatHangs) {
  const std::string error = load_error(testing::standin_dir() / "libhang.so", std::chrono::milliseconds(200));
  EXPECT_NE(error.find("loading the library takes longer than 0.2 s"), std::string::npos) << error;
}

TEST(DynamicLibrary, ReportsALoadThatKillsTheProgram) {
  const std::string error = load_error(testing::standin_dir() / "libcrash.so");
  EXPECT_NE(error.find("ends the program (signal 6)"), std::string::npos) << error;
}

TEST(DynamicLibrary, SecondLoadNeedsNoTrial) {
  const fs::path library = testing::standin_dir() / "libdhd.so";
  EXPECT_EQ(load_error(library), "");
  EXPECT_EQ(load_error(library, std::chrono::milliseconds(0)), "") << "it is loaded already";
}

}  // namespace
}  // namespace trocar::devices
