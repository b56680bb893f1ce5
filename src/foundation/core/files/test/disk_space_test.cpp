#include <gtest/gtest.h>

#include "core/files/file_system.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"

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
