#include "signing/signing_key.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <thread>
#include <vector>

#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "signing/token.h"

namespace trocar::signing {
namespace {

namespace fs = std::filesystem;

/// RFC 8032, section 7.1, tests 1 and 2.
struct Vector {
  const char *secret, *public_key, *signature;
  std::string_view message;
};
constexpr Vector kVectors[] = {
    {"9d61b19deffd5a60ba844af492ec2cc44449c5697b326919703bac031cae7f60",
     "d75a980182b10ab7d54bfed3c964073a0ee172f3daa62325af021a68f707511a",
     "e5564300c360ac729086e2cc806e828a84877f1eb8e5d974d873e065224901555fb8821590a33bacc61e39701cf9b46bd25bf5f0595bbe246"
     "5"
     "5141438e7a100b",
     ""},
    {"4ccd089b28ff96da9db6c346ec114e0f5b8a319f35aba624da8cf6ed4fb8a6fb",
     "3d4017c3e843895a92b70aa74d1b7ebc9c982ccf2ec4968cc0cd55f12af4660c",
     "92a009a9f0d4cab8720e820b5f642540a2b27b5416503f8fb3762223ebdb69da085ac1e43e15996e458f3613d0f11d8c387b2eaeb4302aeeb"
     "0"
     "0d291612bb0c00",
     "\x72"},
};

TEST(SigningKey, AgreesWithRfc8032) {
  for (const Vector& vector : kVectors) {
    const auto key = SigningKey::from_seed(*parse_public_key(vector.secret));  // as many bytes as a public key
    ASSERT_TRUE(key);
    EXPECT_EQ(to_hex(key->public_key()), vector.public_key);
    EXPECT_EQ(to_hex(key->sign(vector.message)), vector.signature);
    EXPECT_TRUE(is_signed_by(key->public_key(), vector.message, *parse_signature(vector.signature)));
    EXPECT_FALSE(is_signed_by(key->public_key(), "other", *parse_signature(vector.signature)));
  }
}

TEST(SigningKey, ChecksEveryBitOfASignature) {
  const auto key = SigningKey::make();
  const auto other = SigningKey::make();
  ASSERT_TRUE(key && other);
  const Signature signature = key->sign("message");
  ASSERT_TRUE(is_signed_by(key->public_key(), "message", signature));
  EXPECT_FALSE(is_signed_by(other->public_key(), "message", signature));
  for (std::size_t bit = 0; bit < 8 * signature.size(); ++bit) {
    Signature changed = signature;
    changed[bit / 8] = static_cast<std::uint8_t>(changed[bit / 8] ^ (1u << (bit % 8)));
    EXPECT_FALSE(is_signed_by(key->public_key(), "message", changed)) << bit;
  }
}

TEST(SigningKey, RefusesMalformedKeys) {
  const std::string hex = kVectors[0].public_key;
  EXPECT_TRUE(parse_public_key(hex));
  EXPECT_FALSE(parse_public_key(""));
  EXPECT_FALSE(parse_public_key(hex.substr(1)));
  EXPECT_FALSE(parse_public_key(hex + "0"));
  EXPECT_FALSE(parse_public_key("g" + hex.substr(1)));
  EXPECT_FALSE(parse_signature(hex));
}

TEST(StationKey, IsCreatedOnceForTheUserOnly) {
  const TemporaryFolder folder;
  const fs::path file = folder / "state/station.key";
  EXPECT_FALSE(load_station_key(file));
  const auto key = open_station_key(file);
  ASSERT_TRUE(key) << key.error().text();
  struct stat status {};
  ASSERT_EQ(::stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777u, 0600u);
  EXPECT_EQ(open_station_key(file)->public_key(), key->public_key());
  EXPECT_EQ(load_station_key(file)->public_key(), key->public_key());
  EXPECT_EQ(std::distance(fs::directory_iterator(file.parent_path()), fs::directory_iterator()), 1);
}

TEST(StationKey, IsTheSameForConcurrentCreators) {
  const TemporaryFolder folder;
  std::vector<PublicKey> keys(8);
  {
    std::vector<std::jthread> threads;
    for (PublicKey& key : keys)
      threads.emplace_back([&] {
        if (const auto made = open_station_key(folder / "station.key")) key = made->public_key();
      });
  }
  EXPECT_NE(keys.front(), PublicKey{});
  for (const PublicKey& key : keys) EXPECT_EQ(key, keys.front());
}

TEST(StationKey, IsRefusedIfReadableByOthersOrDamaged) {
  const TemporaryFolder folder;
  const fs::path file = folder / "station.key";
  ASSERT_TRUE(open_station_key(file));
  fs::permissions(file, fs::perms::group_read, fs::perm_options::add);
  const auto open_to_others = open_station_key(file);
  ASSERT_FALSE(open_to_others);
  EXPECT_NE(open_to_others.error().text().find("other users"), std::string::npos);
  fs::permissions(file, fs::perms::group_read, fs::perm_options::remove);
  const std::string text = *read_file(file);
  for (const std::string& bad : {std::string(), std::string("x"), text.substr(0, text.size() - 2), text + "00"}) {
    fs::remove(file);
    ASSERT_TRUE(write_private_file(file, bad));
    EXPECT_FALSE(open_station_key(file)) << bad;
  }
}

TEST(Sha256, AgreesWithFips180) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(Sha256, OfAFileEqualsThatOfItsBytes) {
  const TemporaryFolder folder;
  const std::string bytes(3'000'001, 'x');  // more than one piece
  ASSERT_TRUE(write_file_atomically(folder / "a", bytes));
  EXPECT_EQ(sha256_of_session(folder / "a"), sha256(bytes));
  EXPECT_FALSE(sha256_of_session(folder / "missing"));
}

}  // namespace
}  // namespace trocar::signing
