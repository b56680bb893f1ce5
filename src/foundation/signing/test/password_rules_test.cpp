#include <gtest/gtest.h>

#include <string>

#include "signing/password.h"

namespace trocar::signing {
namespace {

bool is_accepted(std::string_view password, std::string_view account = "weber") {
  return check_new_password(password, account).has_value();
}

TEST(PasswordRules, CountLengthInCodePoints) {
  EXPECT_FALSE(is_accepted("tribal plum"));
  EXPECT_TRUE(is_accepted("tribal plums"));
  EXPECT_FALSE(is_accepted("blåbærsylte"));  // 11 characters, 13 bytes
  EXPECT_TRUE(is_accepted("blåbærsyltet"));
  std::string longest;
  for (int n = 0; n < 64; ++n) longest += "é" + std::string(1, static_cast<char>('!' + n));
  EXPECT_TRUE(is_accepted(longest));
  EXPECT_FALSE(is_accepted(longest + "x"));
}

TEST(PasswordRules, AnyCharacterIsAllowed) {
  EXPECT_TRUE(is_accepted("    spaces  of  a  typist "));
  EXPECT_TRUE(is_accepted("\xF0\x9F\xA6\x94 igel im wald'; --"));
  EXPECT_TRUE(is_accepted("只要是一个很长的中文密码"));
  EXPECT_TRUE(is_accepted(std::string("tab\tand\0zero byte", 17)));
  EXPECT_FALSE(is_accepted("not utf-8 at all \xFF\xFE"));
}

TEST(PasswordRules, RequireNoCharacterClasses) {
  EXPECT_TRUE(is_accepted("grinding copper lids"));
  EXPECT_TRUE(is_accepted("GRINDINGCOPPERLIDS"));
  EXPECT_TRUE(is_accepted("739164820557"));
}

TEST(PasswordRules, CommonPasswordsAreRefused) {
  for (const char* common :
       {"passwordpassword", "Password123456", "P@ssw0rd2024!!", "123456789012",        "098765432109",
        "qwertyuiop12",     "qwertyuiop[]",   "1q2w3e4r5t6y",   "1qaz2wsx3edc",        "administrator",
        "administrator1",   "letmein123456",  "iloveyou1234",   "welcome12345",        "abcdefghijkl",
        "aaaaaaaaaaaa",     "abcabcabcabc",   "asdfghjkl123",   "Summer2024!!!",       "Hospital2025",
        "trustno1trustno1", "000000000000",   "!!!!!!!!!!!!",   "Trocar-Trainer-2026", "test-test-1234",
        "zxcvbnm12345",     "monkey123456",   "football2023",   "superman1234",        "changeme1234"}) {
    EXPECT_TRUE(is_common_password(common)) << common;
    EXPECT_FALSE(is_accepted(common)) << common;
  }
}

TEST(PasswordRules, AcceptUncommonPasswords) {
  for (const char* fine : {"grinding copper lids", "correct horse battery staple", "password of a hedgehog",
                           "xK7#pQz!mV2w", "die Katze sitzt im Regal"}) {
    EXPECT_FALSE(is_common_password(fine)) << fine;
  }
}

TEST(PasswordRules, NameOfTheAccountIsRefused) {
  EXPECT_FALSE(is_accepted("Frau Dr. Weber", "frau dr. weber"));
  EXPECT_FALSE(is_accepted("weberweberweber", "Weber"));
  EXPECT_FALSE(is_accepted("weber20260101", "weber"));
  EXPECT_TRUE(is_accepted("weber hat vier pfoten", "weber"));
}

TEST(PasswordRules, ErrorsNeverShowThePassword) {
  for (const char* bad : {"brevity", "passwordpassword", "weberweberweber"})
    EXPECT_EQ(check_new_password(bad, "weber").error().text().find(bad), std::string::npos);
}

TEST(PinRules, RequireFourToTwelveDigits) {
  EXPECT_TRUE(check_new_pin("4711"));
  EXPECT_TRUE(check_new_pin("123456789012"));
  for (const char* bad : {"", "123", "1234567890123", "12a4", "12 34", "１２３４", "7777"})
    EXPECT_FALSE(check_new_pin(bad)) << bad;
}

}  // namespace
}  // namespace trocar::signing
