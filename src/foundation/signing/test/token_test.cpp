#include "signing/token.h"

#include <gtest/gtest.h>

#include <set>

namespace trocar::signing {
namespace {

TEST(Token, IsRandomAndSafeInUrls) {
  std::set<std::string> tokens;
  for (int n = 0; n < 1000; ++n) {
    const std::string token = make_token(128).value();
    EXPECT_EQ(token.size(), 22U);
    EXPECT_EQ(token.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_"),
              std::string::npos)
        << token;
    tokens.insert(token);
  }
  EXPECT_EQ(tokens.size(), 1000U);
  EXPECT_EQ(make_token(256).value().size(), 43U);
}

/// 6000 characters in 64 equal classes: chi-squared with 63 degrees of freedom exceeds 150 with probability 4e-9.
TEST(Token, CharactersAreEquallyFrequent) {
  std::array<int, 256> count{};
  constexpr int kTokens = 300, kCharacters = 20;  // the last of 22 has two bits alone
  for (int n = 0; n < kTokens; ++n) {
    const std::string token = make_token(128).value();
    for (const char c : token.substr(0, kCharacters)) ++count[static_cast<unsigned char>(c)];
  }
  const double expected = kTokens * kCharacters / 64.0;
  double chi_squared = 0.0;
  for (const int observed : count)
    if (observed > 0) chi_squared += (observed - expected) * (observed - expected) / expected;
  EXPECT_LT(chi_squared, 150.0);
}

/// SHA-256 of "abc": FIPS 180-4, as given by NIST.
TEST(Token, DigestIsSha256) {
  EXPECT_EQ(token_digest("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(SameSecret, ComparesLengthAndBytes) {
  EXPECT_TRUE(is_same_secret("", ""));
  EXPECT_TRUE(is_same_secret("token", "token"));
  EXPECT_FALSE(is_same_secret("token", "tokem"));
  EXPECT_FALSE(is_same_secret("token", "token "));
  EXPECT_FALSE(is_same_secret("token", ""));
}

}  // namespace
}  // namespace trocar::signing
