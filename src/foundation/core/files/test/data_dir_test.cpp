#include <gtest/gtest.h>

#include "core/files/folders.h"
#include "core/testing/data_folder.h"

namespace trocar {
namespace {

TEST(DataDir, ComesFromTheEnvironment) {
  const std::filesystem::path before = data_dir();
  EXPECT_TRUE(std::filesystem::exists(before / "tissues.toml"));
  {
    const testing::OwnDataFolder own;
    EXPECT_NE(data_dir(), before);
    ASSERT_TRUE(checked_data_dir());
    EXPECT_EQ(*checked_data_dir(), data_dir());
    EXPECT_TRUE(std::filesystem::exists(data_dir() / "tissues.toml"));
  }
  EXPECT_EQ(data_dir(), before);
}

}  // namespace
}  // namespace trocar
