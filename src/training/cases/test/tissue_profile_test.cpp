#include "cases/tissue_profile.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/files/folders.h"

namespace trocar::cases {
namespace {

class Profiles : public ::testing::Test {
 protected:
  void SetUp() override {
    auto loaded = anatomy::load_tissue_table(data_dir() / "tissues.toml");
    ASSERT_TRUE(loaded) << loaded.error().text();
    table = *std::move(loaded);
  }
  anatomy::TissueTable table;
  TemporaryFolder folder;
  const TissueProfile soft{"Soft liver, \"Ms. Ä\"", "fitted by hand", "combined", {"liver.mu=0.2", "skin.fp=4.5"}};
};

TEST_F(Profiles, RoundTrip) {
  ASSERT_TRUE(save_profile(soft, table, folder / "profiles", false));
  const ProfileList list = list_profiles(folder / "profiles");
  EXPECT_TRUE(list.problems.empty());
  ASSERT_EQ(list.profiles.size(), 1u);
  EXPECT_EQ(list.profiles[0].name, soft.name);
  EXPECT_EQ(list.profiles[0].note, soft.note);
  EXPECT_EQ(list.profiles[0].force_model, soft.force_model);
  EXPECT_EQ(list.profiles[0].overrides, soft.overrides);
  const auto fitted = with_profile(table, list.profiles[0]);
  ASSERT_TRUE(fitted);
  EXPECT_EQ(fitted->layers[*fitted->find_layer("skin")].puncture_force_n, 4.5);
}

TEST_F(Profiles, KeepEveryCharacterOfANote) {
  TissueProfile odd = soft;
  odd.note = "tab\t, DEL\x7f, quote\", backslash\\, line\nend, \xc3\xa4";
  ASSERT_TRUE(save_profile(odd, table, folder.path(), false));
  const auto loaded = load_profile(profile_file(folder.path(), odd.name));
  ASSERT_TRUE(loaded) << loaded.error().text();
  EXPECT_EQ(loaded->note, odd.note);
}

TEST_F(Profiles, AreReplacedOnlyOnRequest) {
  ASSERT_TRUE(save_profile(soft, table, folder.path(), false));
  TissueProfile other = soft;
  other.overrides = {"skin.fp=3"};
  const Status refused = save_profile(other, table, folder.path(), false);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().exit_status, 2);
  EXPECT_EQ(load_profile(profile_file(folder.path(), soft.name))->overrides, soft.overrides);
  ASSERT_TRUE(save_profile(other, table, folder.path(), true));
  EXPECT_EQ(load_profile(profile_file(folder.path(), soft.name))->overrides, other.overrides);
}

TEST_F(Profiles, AreDeletedFromTheirOwnFolder) {
  ASSERT_TRUE(save_profile(soft, table, folder.path(), false));
  std::filesystem::rename(profile_file(folder.path(), soft.name), folder / "mine.toml");
  const ProfileList list = list_profiles(folder.path());
  ASSERT_EQ(list.profiles.size(), 1u);
  EXPECT_EQ(list.profiles[0].file, folder / "mine.toml");
  ASSERT_TRUE(delete_profile(list.profiles[0]));
  EXPECT_TRUE(folder.is_empty());
  std::filesystem::create_directories(folder / "full" / "more");
  TissueProfile wrong = soft;
  wrong.file = folder / "full";
  EXPECT_FALSE(delete_profile(wrong));
}

TEST_F(Profiles, AreNotWrittenWithInvalidNumbers) {
  TissueProfile wrong = soft;
  wrong.overrides = {"liver.mu=700"};
  const Status status = save_profile(wrong, table, folder / "none", false);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().exit_status, 2);
  EXPECT_FALSE(std::filesystem::exists(folder / "none"));
}

TEST_F(Profiles, CannotLeaveTheirFolderOrBeNameless) {
  EXPECT_EQ(profile_file(folder.path(), "../../etc/passwd").parent_path(), folder.path());
  for (const std::string& name : {std::string(), std::string("   "), std::string(200, 'x'), std::string("a\nb"),
                                  std::string("a\x7f"
                                              "b")}) {
    TissueProfile profile = soft;
    profile.name = name;
    EXPECT_FALSE(save_profile(profile, table, folder.path(), true)) << name;
  }
  EXPECT_TRUE(folder.is_empty());
}

TEST_F(Profiles, AreNamedWhenUnreadable) {
  ASSERT_TRUE(save_profile(soft, table, folder.path(), false));
  std::ofstream(folder / "broken.toml") << "name = \"x\"\noverides = []\n";
  const ProfileList list = list_profiles(folder.path());
  EXPECT_EQ(list.profiles.size(), 1u);
  ASSERT_EQ(list.problems.size(), 1u);
  EXPECT_NE(list.problems[0].find("overides"), std::string::npos) << list.problems[0];
  EXPECT_TRUE(list_profiles(folder / "nowhere").profiles.empty());
}

}  // namespace
}  // namespace trocar::cases
