#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <iterator>

#include "core/files/folders.h"
#include "core/files/output_file.h"

namespace trocar {
inline namespace core {
namespace {
namespace fs = std::filesystem;

/// A folder of its own for every test, removed after it.
class AtomicFile : public ::testing::Test {
 protected:
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator{}));
  }

  TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

/// While it lives, files of this process cannot grow past a size: what a write meets on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    signal_before_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, signal_before_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*signal_before_)(int) = nullptr;
};

TEST_F(AtomicFile, WritesTheGivenBytes) {
  const fs::path target = folder_ / "a.txt";
  ASSERT_TRUE(write_file_atomically(target, "one"));
  EXPECT_EQ(read_file(target).value(), "one");
  ASSERT_TRUE(write_file_atomically(target, std::string_view("t\0wo", 4)));
  EXPECT_EQ(read_file(target).value(), std::string_view("t\0wo", 4));
  EXPECT_EQ(entries(), 1u);
}

TEST_F(AtomicFile, MakesMissingFolders) {
  ASSERT_TRUE(write_file_atomically(folder_ / "new" / "deeper" / "a.txt", "x"));
  EXPECT_TRUE(fs::exists(folder_ / "new" / "deeper" / "a.txt"));
}

TEST_F(AtomicFile, KeepsTheOldFileWhenTheDiskIsFull) {
  const fs::path target = folder_ / "a.bin";
  ASSERT_TRUE(write_file_atomically(target, "old"));
  {
    const FullDisk full(100'000);
    const Status status = write_file_atomically(target, std::string(1'000'000, 'x'));
    ASSERT_FALSE(status);
    EXPECT_NE(status.error().text().find("disk space"), std::string::npos) << status.error().text();
  }
  EXPECT_EQ(read_file(target).value(), "old");
  EXPECT_EQ(entries(), 1u);  // no part is left behind
}

TEST_F(AtomicFile, LeavesNothingWhereTheWriterFails) {
  const Status status = write_atomically(folder_ / "a.txt", [](const fs::path& temporary) -> Status {
    std::ofstream(temporary) << "half";
    return fail("no more voxels");
  });
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().what, "no more voxels");
  EXPECT_EQ(entries(), 0u);
}

TEST_F(AtomicFile, FailsWhenTheWriterWritesNothing) {
  EXPECT_FALSE(write_atomically(folder_ / "a.txt", [](const fs::path&) -> Status { return {}; }));
  EXPECT_EQ(entries(), 0u);
}

TEST_F(AtomicFile, KeepsTheFileExtension) {
  for (const char* name : {"ct.nii.gz", "ct.nrrd", "mesh.vtp"}) {
    ASSERT_TRUE(write_atomically(folder_ / name, [&](const fs::path& temporary) -> Status {
      EXPECT_EQ(temporary.parent_path(), folder_);
      EXPECT_NE(temporary.filename(), name);
      EXPECT_TRUE(temporary.string().ends_with(std::string(name).substr(std::string(name).find('.'))));
      std::ofstream(temporary) << "x";
      return {};
    }));
  }
  EXPECT_EQ(entries(), 3u);
}

TEST_F(AtomicFile, RefusesATargetInsideAFile) {
  ASSERT_TRUE(write_file_atomically(folder_ / "file", "x"));
  const Status status = write_file_atomically(folder_ / "file" / "a.txt", "y");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().exit_status, 1);
  EXPECT_FALSE(write_folder_atomically(folder_ / "file" / "sub", [](const fs::path&) -> Status { return {}; }));
}

Status write_two_files(const fs::path& temporary) {
  TROCAR_TRY_STATUS(write_file_atomically(temporary / "a", "1"));
  return write_file_atomically(temporary / "b", "2");
}

TEST_F(AtomicFile, WritesACompleteFolder) {
  ASSERT_TRUE(write_folder_atomically(folder_ / "patient", write_two_files));
  EXPECT_EQ(read_file(folder_ / "patient" / "b").value(), "2");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(AtomicFile, WritesAFolderWithATrailingSlash) {
  const Status status = write_folder_atomically(folder_.string() + "/patient/", write_two_files);
  ASSERT_TRUE(status) << status.error().text();
  EXPECT_EQ(read_file(folder_ / "patient" / "a").value(), "1");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(AtomicFile, NeverOverwritesANonEmptyFolder) {
  fs::create_directories(folder_ / "patient");
  ASSERT_TRUE(write_folder_atomically(folder_ / "patient", write_two_files));  // an empty one is taken
  const Status again = write_folder_atomically(folder_ / "patient", write_two_files);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().exit_status, 2);
  ASSERT_TRUE(write_file_atomically(folder_ / "file", "x"));
  EXPECT_FALSE(write_folder_atomically(folder_ / "file", write_two_files));
  EXPECT_EQ(read_file(folder_ / "file").value(), "x");
}

TEST_F(AtomicFile, LeavesNoFolderWhereTheWriterFails) {
  EXPECT_FALSE(write_folder_atomically(folder_ / "patient", [](const fs::path& temporary) -> Status {
    TROCAR_TRY_STATUS(write_two_files(temporary));
    return fail("no labels");
  }));
  EXPECT_EQ(entries(), 0u);
}

TEST_F(AtomicFile, ReportsReadErrors) {
  EXPECT_EQ(read_file(folder_ / "none").error().what, "no such file");
  EXPECT_EQ(read_file(folder_).error().what, "is a folder, not a file");
  ASSERT_TRUE(write_file_atomically(folder_ / "long", "123456"));
  EXPECT_FALSE(read_file(folder_ / "long", 5));
  EXPECT_EQ(read_file(folder_ / "long", 6).value(), "123456");
}

}  // namespace
}  // namespace core
}  // namespace trocar
