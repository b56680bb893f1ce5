#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>

#include "core/files/folders.h"
#include "core/files/output_file.h"

namespace trocar {
inline namespace core {
namespace {
namespace fs = std::filesystem;

std::string refusal(const fs::path& target) {
  const Status status = check_can_write(target);
  return status ? std::string() : status.error().text();
}

TEST(OutputCheck, LeavesNothingBehind) {
  const TemporaryFolder folder;
  EXPECT_TRUE(check_can_write(folder / "file.csv"));
  EXPECT_TRUE(check_can_write(folder / "new/deep/folder"));
  EXPECT_TRUE(check_can_write((folder / "folder/").string()));
  EXPECT_TRUE(folder.is_empty());
}

TEST(OutputCheck, DetectsUnwritablePaths) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  EXPECT_NE(refusal(folder / "file/below").find("Not a directory"), std::string::npos);
  EXPECT_NE(refusal(folder / "file/below/that").find("Not a directory"), std::string::npos);
  EXPECT_NE(refusal("/proc/nothing/here"), "");
  EXPECT_NE(refusal("/proc/nothing"), "");
  EXPECT_NE(refusal(folder.path() / std::string(300, 'x')).find("shorter name"), std::string::npos);
}

TEST(OutputCheck, FindsAFullDisk) {
  const TemporaryFolder folder;
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit none{0, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &none);
  const std::string text = refusal(folder / "file");
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_NE(text.find("free some disk space"), std::string::npos) << text;
  EXPECT_TRUE(folder.is_empty());
}

}  // namespace
}  // namespace core
}  // namespace trocar
