#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "link/endpoint.h"

namespace trocar::link {
namespace {
namespace fs = std::filesystem;

// The client's pair in libzmq's manual, zmq_curve(7).
constexpr const char* kPublic = "Yne@$w-vo<fVvi]a<NY6T1ed:M$fCG*[IaLV{hID";
constexpr const char* kSecret = "D:)Q[IlAW!ahhC2ac:9*A}h:p?([4%wOTJ%JR%cs";

mode_t mode_of(const fs::path& file) {
  struct stat status {};
  EXPECT_EQ(::stat(file.c_str(), &status), 0) << file;
  return status.st_mode & 0777u;
}

fs::path write_file(const TemporaryFolder& folder, const std::string& text, mode_t mode = 0600) {
  const fs::path file = folder / "file";
  std::ofstream(file, std::ios::binary) << text;
  EXPECT_EQ(::chmod(file.c_str(), mode), 0);
  return file;
}

std::string pair_text(const std::string& public_key, const std::string& secret_key) {
  return "public " + public_key + "\nsecret " + secret_key + "\n";
}

TEST(KeyFolder, HoldsMatchingKeyPairs) {
  const TemporaryFolder folder;
  const fs::path keys = folder / "keys";
  ASSERT_TRUE(write_key_folder(keys));
  const auto server = load_curve_keys(keys / "server.key"), client = load_curve_keys(keys / "client.key");
  ASSERT_TRUE(server) << server.error().text();
  ASSERT_TRUE(client) << client.error().text();
  EXPECT_EQ(load_public_key(keys / "server.pub").value(), server->public_key);
  EXPECT_EQ(load_public_key(keys / "client.pub").value(), client->public_key);
  EXPECT_EQ(load_allow_list(keys / "allowed").value(), std::set<std::string>{client->public_key});
  EXPECT_NE(server->secret_key, client->secret_key);
}

TEST(KeyFolder, MakesSecretsReadableOnlyByTheUser) {
  const TemporaryFolder folder;
  const fs::path keys = folder / "keys";
  const mode_t before = ::umask(0);
  const Status written = write_key_folder(keys);
  ::umask(before);
  ASSERT_TRUE(written);
  EXPECT_EQ(mode_of(keys), 0700u);
  EXPECT_EQ(mode_of(keys / "server.key"), 0600u);
  EXPECT_EQ(mode_of(keys / "client.key"), 0600u);
}

TEST(KeyFolder, NothingIsOverwritten) {
  const TemporaryFolder folder;
  const fs::path keys = folder / "keys";
  ASSERT_TRUE(write_key_folder(keys));
  const std::string before = read_file(keys / "server.key").value();
  const Status again = write_key_folder(keys);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().exit_status, 2);
  EXPECT_EQ(read_file(keys / "server.key").value(), before);
}

TEST(CurveKeys, NewPairsAreReadBack) {
  const TemporaryFolder folder;
  constexpr int kPairs = 10;
  std::set<std::string> secrets;
  for (int i = 0; i < kPairs; ++i) {
    const auto keys = make_curve_keys();
    ASSERT_TRUE(keys);
    const auto loaded = load_curve_keys(write_file(folder, pair_text(keys->public_key, keys->secret_key)));
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_EQ(loaded->public_key, keys->public_key);
    EXPECT_TRUE(secrets.insert(loaded->secret_key).second);
    EXPECT_EQ(load_public_key(write_file(folder, keys->public_key + "\n")).value(), keys->public_key);
  }
}

TEST(CurveKeys, FileThatOthersCanReadIsRefused) {
  const TemporaryFolder folder;
  EXPECT_TRUE(load_curve_keys(write_file(folder, pair_text(kPublic, kSecret), 0400)));
  for (const mode_t mode : {0640u, 0604u, 0660u, 0644u}) {
    const auto keys = load_curve_keys(write_file(folder, pair_text(kPublic, kSecret), mode));
    ASSERT_FALSE(keys);
    EXPECT_NE(keys.error().text().find("chmod 600"), std::string::npos);
  }
}

TEST(CurveKeys, RefusesAFileWithoutAKeyPair) {
  const TemporaryFolder folder;
  const std::string other = make_curve_keys()->public_key;
  const std::string good = pair_text(kPublic, kSecret);
  for (const std::string& text :
       {std::string(), std::string("public ") + kPublic + "\n", pair_text(kPublic, ""), pair_text(other, kSecret),
        pair_text(kPublic, std::string(40, '"')), pair_text(kPublic, std::string(39, 'a')),
        pair_text(kPublic, std::string(40, '#')), good + "secret " + kSecret + "\n", good + "x\n",
        std::string("public ") + kPublic + " x y\n", std::string(1 << 16, ' ')}) {
    EXPECT_FALSE(load_curve_keys(write_file(folder, text))) << text.substr(0, 200);
  }
  EXPECT_FALSE(load_curve_keys(folder / "none"));
  EXPECT_FALSE(load_curve_keys(folder.path()));
}

TEST(CurveKeys, WrongLineIsNamed) {
  const TemporaryFolder folder;
  const auto keys = load_allow_list(write_file(folder, std::string("# ours\n") + kPublic + "\nnot a key\n"));
  ASSERT_FALSE(keys);
  EXPECT_NE(keys.error().text().find("line 3"), std::string::npos) << keys.error().text();
}

TEST(AllowList, SkipsCommentsAndEmptyLines) {
  const TemporaryFolder folder;
  const std::string other = make_curve_keys()->public_key;
  const std::string text = "# clients\r\n\n  " + std::string(kPublic) + "  # the trainer\n#" + other + "\n# " + other;
  EXPECT_EQ(load_allow_list(write_file(folder, text)).value(), std::set<std::string>{kPublic});
}

TEST(AllowList, WithoutAKeyIsRefused) {
  const TemporaryFolder folder;
  for (const char* text : {"", "\n", "# nobody\n"}) {
    const auto allowed = load_allow_list(write_file(folder, text));
    ASSERT_FALSE(allowed) << text;
    EXPECT_NE(allowed.error().text().find("no key"), std::string::npos) << allowed.error().text();
  }
}

/// All three kinds of files, by their error.
std::vector<std::string> errors_of(const fs::path& keys) {
  std::vector<std::string> errors;
  const auto note = [&](const auto& loaded) { errors.push_back(loaded ? std::string() : loaded.error().text()); };
  note(load_curve_keys(keys / "server.key"));
  note(load_public_key(keys / "server.pub"));
  note(load_allow_list(keys / "allowed"));
  return errors;
}

TEST(KeyFolder, IsRefusedIfOthersCanWriteIt) {
  const TemporaryFolder folder;
  const fs::path keys = folder / "above" / "keys";
  fs::create_directory(folder / "above");
  ASSERT_TRUE(write_key_folder(keys));
  for (const fs::path& open : {keys, keys.parent_path()}) {
    for (const mode_t mode : {0777u, 0770u, 0707u, 0720u}) {
      ASSERT_EQ(::chmod(open.c_str(), mode), 0);
      for (const std::string& error : errors_of(keys)) {
        EXPECT_NE(error.find(fmt::format("chmod go-w {}", open.string())), std::string::npos) << error;
      }
    }
    for (const mode_t mode : {01777u, 0755u, 0700u}) {
      ASSERT_EQ(::chmod(open.c_str(), mode), 0);
      EXPECT_EQ(errors_of(keys), std::vector<std::string>(3)) << open << std::oct << mode;
    }
  }
}

TEST(KeyFolder, ChecksALinkAndItsTarget) {
  const TemporaryFolder folder;
  const fs::path keys = folder / "keys", links = folder / "links";
  ASSERT_TRUE(write_key_folder(keys));
  fs::create_directory(links);
  for (const char* name : {"server.key", "server.pub", "allowed"}) fs::create_symlink(keys / name, links / name);
  EXPECT_EQ(errors_of(links), std::vector<std::string>(3));
  for (const fs::path& open : {keys, links}) {
    ASSERT_EQ(::chmod(open.c_str(), 0777), 0);
    for (const std::string& error : errors_of(links)) EXPECT_NE(error, "") << open;
    ASSERT_EQ(::chmod(open.c_str(), 0700), 0);
  }
}

TEST(KeyFolder, FilesOfAnotherUserAreRefused) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can give a file away";
  const TemporaryFolder folder;
  const fs::path keys = folder / "keys";
  ASSERT_TRUE(write_key_folder(keys));
  constexpr uid_t kAnother = 12345;
  for (const char* name : {"server.key", "server.pub", "allowed"})
    ASSERT_EQ(::chown((keys / name).c_str(), kAnother, kAnother), 0);
  for (const std::string& error : errors_of(keys))
    EXPECT_NE(error.find("belongs to another user"), std::string::npos) << error;
  for (const char* name : {"server.key", "server.pub", "allowed"}) ASSERT_EQ(::chown((keys / name).c_str(), 0, 0), 0);
  EXPECT_EQ(errors_of(keys), std::vector<std::string>(3));
  ASSERT_EQ(::chown(keys.c_str(), kAnother, kAnother), 0);
  for (const std::string& error : errors_of(keys))
    EXPECT_NE(error.find("belongs to another user"), std::string::npos) << error;
}

TEST(AllowList, FileThatOthersCanWriteIsRefused) {
  const TemporaryFolder folder;
  const std::string line = std::string(kPublic) + "\n";
  for (const mode_t mode : {0660u, 0666u, 0622u, 0602u}) {
    const auto allowed = load_allow_list(write_file(folder, line, mode));
    ASSERT_FALSE(allowed);
    EXPECT_NE(allowed.error().text().find("chmod go-w"), std::string::npos) << allowed.error().text();
    EXPECT_FALSE(load_public_key(write_file(folder, line, mode)));
  }
  EXPECT_TRUE(load_allow_list(write_file(folder, line, 0644)));
}

TEST(PublicKey, FileHoldsExactlyOneKey) {
  const TemporaryFolder folder;
  const std::string other = make_curve_keys()->public_key;
  EXPECT_FALSE(load_public_key(write_file(folder, "# none\n")));
  EXPECT_FALSE(load_public_key(write_file(folder, other + "\n" + kPublic + "\n")));
  EXPECT_FALSE(load_public_key(folder / "none"));
  EXPECT_FALSE(load_public_key(write_file(folder, std::string(40, '$') + "\n"))) << "more than 32 bits in a group";
}

}  // namespace
}  // namespace trocar::link
