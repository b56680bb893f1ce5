#include "results/accounts.h"

#include "results_lab.h"

namespace trocar::results {
namespace {

class Accounts : public ResultsTest {};
TROCAR_BOTH_DATABASES(Accounts);

TEST_P(Accounts, AreFoundByName) {
  const auto added = add_account(*repository_, "Eva", Role::kAdmin, "hash", kNow);
  ASSERT_TRUE(added);
  EXPECT_FALSE(add_account(*repository_, "EVA", Role::kInstructor, "other", kNow));
  const auto found = find_account(*repository_, "eva");
  ASSERT_TRUE(found && *found);
  EXPECT_EQ((*found)->password_hash, "hash");
  EXPECT_EQ((*found)->role, Role::kAdmin);
  EXPECT_FALSE(find_account(*repository_, "' OR 1=1 --")->has_value());
  EXPECT_EQ(list_accounts(*repository_)->size(), 1u);
}

TEST_P(Accounts, RefusesToRemoveTheLastAdmin) {
  ASSERT_TRUE(add_account(*repository_, "Eva", Role::kAdmin, "a", kNow));
  ASSERT_TRUE(add_account(*repository_, "Ben", Role::kInstructor, "b", kNow));
  EXPECT_FALSE(remove_account(*repository_, "Eva"));
  EXPECT_TRUE(remove_account(*repository_, "ben"));
  EXPECT_FALSE(remove_account(*repository_, "ben"));
  ASSERT_TRUE(add_account(*repository_, "Anna", Role::kAdmin, "c", kNow));
  EXPECT_TRUE(remove_account(*repository_, "Eva"));
}

TEST_P(Accounts, LoginsEndByTimeNewPasswordOrRemoval) {
  const Account eva = *add_account(*repository_, "Eva", Role::kAdmin, "a", kNow);
  const Account ben = *add_account(*repository_, "Ben", Role::kAdmin, "b", kNow);
  const auto add_login = [&](const std::string& token, Seconds begun, const Account& account) {
    ASSERT_TRUE(add_web_session(*repository_, {token, "csrf", begun, begun, account}));
  };
  add_login("now", kNow, eva);
  add_login("old", kNow - std::chrono::hours(13), eva);
  add_login("future", kNow + std::chrono::hours(1), eva);
  add_login("bens", kNow, ben);
  const auto found = find_web_session(*repository_, "now");
  ASSERT_TRUE(found && *found);
  EXPECT_EQ((*found)->account.id, eva.id);
  EXPECT_EQ((*found)->csrf_token, "csrf");
  ASSERT_TRUE(
      remove_old_web_sessions(*repository_, kNow - std::chrono::minutes(30), kNow - std::chrono::hours(12), kNow));
  EXPECT_FALSE(find_web_session(*repository_, "old")->has_value());
  EXPECT_FALSE(find_web_session(*repository_, "future")->has_value());
  add_login("second", kNow, eva);
  ASSERT_TRUE(change_password(*repository_, eva.id, "new", "now"));
  EXPECT_TRUE(find_web_session(*repository_, "now")->has_value());
  EXPECT_FALSE(find_web_session(*repository_, "second")->has_value());
  EXPECT_EQ((*find_account(*repository_, "Eva"))->password_hash, "new");
  ASSERT_TRUE(touch_web_session(*repository_, "now", kNow + std::chrono::minutes(5)));
  EXPECT_EQ((*find_web_session(*repository_, "now"))->used, kNow + std::chrono::minutes(5));
  ASSERT_TRUE(end_web_session(*repository_, "now"));
  EXPECT_FALSE(find_web_session(*repository_, "now")->has_value());
  ASSERT_TRUE(remove_account(*repository_, "Ben"));
  EXPECT_FALSE(find_web_session(*repository_, "bens")->has_value());
}

}  // namespace
}  // namespace trocar::results
