#include "signing/password.h"

#include <gtest/gtest.h>

namespace trocar::signing {
namespace {

/// Little work: these tests are about the format.
constexpr PasswordWork kQuick{1, std::size_t{8} << 10};

std::string quick_hash(std::string_view password) {
  return hash_password(password, kQuick).value();
}

TEST(Password, IsVerifiedByItsHash) {
  const std::string hash = quick_hash("four words of nobody");
  EXPECT_TRUE(is_password(hash, "four words of nobody"));
  EXPECT_FALSE(is_password(hash, "four words of nobodY"));
  EXPECT_FALSE(is_password(hash, "four words of nobody "));
  EXPECT_FALSE(is_password(hash, ""));
  EXPECT_EQ(hash.find("nobody"), std::string::npos);
}

TEST(Password, ComparesEveryByte) {
  const std::string with_zero("a long\0password", 15);
  EXPECT_FALSE(is_password(quick_hash(with_zero), "a long"));
  EXPECT_TRUE(is_password(quick_hash(with_zero), with_zero));
  const std::string longest(512, 'x');  // 128 characters of four bytes
  EXPECT_FALSE(is_password(quick_hash(longest), longest.substr(1)));
}

TEST(Password, HashUsesAFreshSalt) {
  EXPECT_NE(quick_hash("the same password"), quick_hash("the same password"));
}

TEST(Password, DefaultHashIsArgon2idWith64MiB) {
  const std::string hash = hash_password("the default work").value();
  EXPECT_TRUE(hash.starts_with("$argon2id$v=19$m=65536,t=2,p=1$")) << hash;
  EXPECT_FALSE(needs_rehash(hash));
  EXPECT_TRUE(needs_rehash(quick_hash("the default work")));
  EXPECT_TRUE(is_password(hash, "the default work"));
}

/// Argon2id of "password" with the salt "somesalt", from the tests of the reference implementation
/// (P-H-C/phc-winner-argon2, src/test.c).
TEST(Password, AgreesWithTheReferenceImplementation) {
  EXPECT_TRUE(is_password("$argon2id$v=19$m=65536,t=2,p=1$c29tZXNhbHQ$CTFhFdXPJO1aFaMaO6Mm5c8y7cJHAph8ArZWb2GRPPc",
                          "password"));
}

TEST(Password, RejectsMalformedOrCostlyHashes) {
  const std::string hash = quick_hash("a password");
  for (const std::string& bad :
       {std::string(), std::string("x"), hash.substr(0, hash.size() - 1), hash + "=", "$2b$10$" + hash,
        std::string("$argon2id$v=19$m=4194304,t=2,p=1$c29tZXNhbHQ$CTFhFdXPJO1aFaMaO6Mm5c8y7cJHAph8ArZWb2GRPPc"),
        std::string("$argon2id$v=19$m=64,t=99,p=1$c29tZXNhbHQ$CTFhFdXPJO1aFaMaO6Mm5c8y7cJHAph8ArZWb2GRPPc"),
        std::string("$argon2id$v=19$m=,t=2,p=1$"), std::string(1000, '$')}) {
    EXPECT_FALSE(is_password(bad, "a password")) << bad;
  }
  EXPECT_TRUE(needs_rehash(""));
  EXPECT_TRUE(needs_rehash("$argon2id$v=19$m=65536"));
}

}  // namespace
}  // namespace trocar::signing
