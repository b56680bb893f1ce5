#include "core/files/disk_space.h"

#include <gtest/gtest.h>

#include "core/files/atomic_file.h"
#include "core/files/temporary_folder.h"

namespace trocar {
inline namespace core {
namespace {

TEST(DiskSpace, IsKnownOnlyForAFolder) {
  const TemporaryFolder folder;
  EXPECT_TRUE(find_free_bytes(folder.path()));
  EXPECT_FALSE(find_free_bytes("/nowhere/at/all"));
}

TEST(DiskSpace, CreatesAnEmptyWritableFolder) {
  const TemporaryFolder folder;
  ASSERT_TRUE(make_writable_folder(folder / "a/b"));
  EXPECT_TRUE(std::filesystem::is_empty(folder / "a/b"));
}

TEST(DiskSpace, NamesAFolderThatCannotBeCreated) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_file_atomically(folder / "file", "text"));
  const Status made = make_writable_folder(folder / "file/inside");
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().where, folder / "file/inside");
  EXPECT_EQ(made.error().what, "Not a directory");
}

}  // namespace
}  // namespace core
}  // namespace trocar
