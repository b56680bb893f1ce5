// Keys for the link to haptic servers.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "cli/program.h"

namespace trocar::cli_test {
namespace {
namespace fs = std::filesystem;

TEST(LinkKeygen, CreatesAPrivateKeyFolder) {
  const TemporaryFolder folder;
  const Outcome outcome = trocar("link keygen --out '" + (folder / "keys") + "'");
  EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  for (const char* name : {"server.key", "server.pub", "client.key", "client.pub", "allowed"}) {
    EXPECT_TRUE(fs::is_regular_file(fs::path(folder / "keys") / name)) << name;
  }
  constexpr fs::perms kOthers = fs::perms::group_all | fs::perms::others_all;
  EXPECT_EQ(fs::status(folder / "keys").permissions() & kOthers, fs::perms::none);
  EXPECT_EQ(fs::status(folder / "keys/server.key").permissions() & kOthers, fs::perms::none);
}

TEST(LinkKeygen, NamesItsFilesAsJson) {
  const TemporaryFolder folder;
  const config::Json json = json_of(trocar("link keygen --json --out '" + (folder / "keys") + "'"));
  EXPECT_EQ(json["server"]["key"], folder / "keys/server.key");
  EXPECT_EQ(json["allowed"], folder / "keys/allowed");
}

TEST(LinkKeygen, NeverPrintsASecret) {
  const TemporaryFolder folder;
  const Outcome outcome = trocar("-v link keygen --out '" + (folder / "keys") + "'");
  std::ifstream file(folder / "keys/server.key");
  std::string secret;
  for (std::string word; file >> word;) secret = word;
  constexpr std::size_t kKeyCharacters = 40;
  ASSERT_EQ(secret.size(), kKeyCharacters);
  EXPECT_EQ((outcome.out + outcome.err).find(secret), std::string::npos);
}

}  // namespace
}  // namespace trocar::cli_test
