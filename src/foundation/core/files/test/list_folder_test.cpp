#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "core/files/folders.h"

namespace trocar {
inline namespace core {
namespace {

namespace fs = std::filesystem;

void touch(const fs::path& file) {
  fs::create_directories(file.parent_path());
  std::ofstream stream(file);
}

std::vector<std::string> names(const Result<std::vector<fs::path>>& listed, const fs::path& top) {
  EXPECT_TRUE(listed) << listed.error().text();
  std::vector<std::string> names;
  if (listed)
    for (const fs::path& path : *listed) names.push_back(path.lexically_relative(top).string());
  return names;
}

TEST(ListFolder, IsSortedAndNotRecursive) {
  const TemporaryFolder folder;
  touch(folder / "b");
  touch(folder / "a" / "inner");
  touch(folder / ".hidden");
  EXPECT_EQ(names(list_folder(folder.path()), folder.path()), (std::vector<std::string>{".hidden", "a", "b"}));
}

TEST(ListFolder, FailsForANonFolder) {
  const TemporaryFolder folder;
  touch(folder / "file");
  for (const char* name : {"nowhere", "file", "file/below", ""}) {
    EXPECT_FALSE(list_folder(*name == '\0' ? fs::path() : folder / name)) << name;
    EXPECT_FALSE(list_tree(*name == '\0' ? fs::path() : folder / name)) << name;
  }
}

TEST(ListTree, ListsFoldersFirstAndFollowsNoLinks) {
  const TemporaryFolder folder;
  touch(folder / "a" / "b" / "c");
  touch(folder / "a" / "x");
  touch(folder / "z");
  fs::create_directory_symlink(folder.path(), folder / "loop");
  fs::create_symlink("nowhere", folder / "dangling");
  EXPECT_EQ(names(list_tree(folder.path()), folder.path()),
            (std::vector<std::string>{"a", "a/b", "a/b/c", "a/x", "dangling", "loop", "z"}));
  EXPECT_EQ(names(list_tree(folder.path(), {.most_depth = 1}), folder.path()),
            (std::vector<std::string>{"a", "a/b", "a/x", "dangling", "loop", "z"}));
  EXPECT_EQ(names(list_tree(folder.path(), {.most_depth = 0}), folder.path()),
            names(list_folder(folder.path()), folder.path()));
}

TEST(ListTree, SkipsAnUnreadableFolderOnlyOnRequest) {
  if (::geteuid() == 0) GTEST_SKIP() << "root reads every folder";
  const TemporaryFolder folder;
  touch(folder / "a" / "file");
  ::chmod((folder / "a").c_str(), 0);
  EXPECT_FALSE(list_tree(folder.path()));
  EXPECT_EQ(names(list_tree(folder.path(), {.skips_unreadable = true}), folder.path()), std::vector<std::string>{"a"});
  ::chmod((folder / "a").c_str(), 0700);
}

/// Folders come and go all the time: none of the lists is an error, and none throws.
TEST(ListTree, SkipsFoldersThatVanishDuringTheWalk) {
  const TemporaryFolder folder;
  touch(folder / "stays");
  std::atomic<bool> is_ending{false};
  std::thread other([&] {
    while (!is_ending) {
      std::error_code ignored;
      fs::create_directories(folder / "comes" / "and" / "goes", ignored);
      fs::remove_all(folder / "comes", ignored);
    }
  });
  for (int n = 0; n < 3000; ++n) {
    const auto listed = list_tree(folder.path());
    EXPECT_TRUE(listed) << listed.error().text();
    if (!listed) break;
    EXPECT_EQ(listed->back(), folder / "stays");
  }
  is_ending = true;
  other.join();
}

}  // namespace
}  // namespace core
}  // namespace trocar
