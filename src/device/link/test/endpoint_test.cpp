#include "link/endpoint.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <filesystem>

#include "core/files/folders.h"
#include "link/detail/ipc_file.h"

namespace trocar::link {
namespace {
namespace fs = std::filesystem;

constexpr int kUnusableArguments = 2;

void expect_refused(std::string_view text) {
  const auto endpoint = parse_endpoint(text);
  ASSERT_FALSE(endpoint) << text;
  EXPECT_EQ(endpoint.error().exit_status, kUnusableArguments) << text;
}

TEST(Endpoint, NeedsKeysExceptForIpc) {
  EXPECT_FALSE(parse_endpoint("ipc:///run/user/0/trocar-needle")->needs_keys);
  for (const char* text : {"tcp://127.0.0.1:5571", "tcp://localhost:5571", "tcp://[::1]:5571", "tcp://0.0.0.0:5571",
                           "tcp://[::]:5571", "tcp://192.168.1.7:5571"}) {
    const auto endpoint = parse_endpoint(text);
    ASSERT_TRUE(endpoint) << text;
    EXPECT_TRUE(endpoint->needs_keys) << text;
  }
}

// inet_aton and others read 0127 as octal: 87.0.0.1.
TEST(Endpoint, AcceptsOnlyCanonicalNumericAddresses) {
  for (const char* text :
       {"tcp://0127.0.0.1:5571", "tcp://127.1:5571", "tcp://127.0.1:1", "tcp://0x7f.0.0.1:1", "tcp://2130706433:1",
        "tcp://127.0.0.1.example.org:1", "tcp://127.example.org:1", "tcp://eth0:1", "tcp://*:5571",
        "tcp://[fe80::1%eth0]:1", "tcp://1270.0.0.1:1", "tcp://256.0.0.1:1", "tcp://[::1:1", "tcp://[127.0.0.1]:1"}) {
    expect_refused(text);
  }
}

TEST(Endpoint, NormalisesTheUrl) {
  EXPECT_EQ(parse_endpoint("tcp://localhost:5571")->url, "tcp://127.0.0.1:5571");
  EXPECT_EQ(parse_endpoint("tcp://127.0.0.1:0")->url, "tcp://127.0.0.1:0");
  EXPECT_EQ(parse_endpoint("tcp://127.0.0.1:65535")->url, "tcp://127.0.0.1:65535");
  EXPECT_EQ(parse_endpoint("ipc:///tmp/a b")->url, "ipc:///tmp/a b");
}

TEST(Endpoint, RefusesMalformedEndpoints) {
  for (const char* text : {"",
                           "needle",
                           "ipc://",
                           "ipc://needle",
                           "ipc://@needle",
                           "ipc://*",
                           "ipc:///tmp/",
                           "ipc:///tmp/a\n",
                           "tcp://",
                           "tcp://127.0.0.1",
                           "tcp://127.0.0.1:",
                           "tcp://:5571",
                           "tcp://127.0.0.1:65536",
                           "tcp://127.0.0.1:-1",
                           "tcp://127.0.0.1:+1",
                           "tcp://127.0.0.1:5571x",
                           "tcp://127.0.0.1:99999999999999999999",
                           "tcp://::1:5571",
                           "tcp://[]:1",
                           "tcp://a;b:1",
                           "tcp://eth0;10.0.0.1:5571",
                           "udp://127.0.0.1:5571",
                           "IPC:///tmp/a"}) {
    expect_refused(text);
  }
}

TEST(Endpoint, LimitsTheSocketPathLength) {
  constexpr std::size_t kMostPathBytes = 107;
  const std::string longest = "/" + std::string(kMostPathBytes - 1, 'a');
  EXPECT_TRUE(parse_endpoint("ipc://" + longest));
  expect_refused("ipc://" + longest + "a");
}

/// XDG_RUNTIME_DIR for the time of a test.
class RuntimeFolder {
 public:
  explicit RuntimeFolder(const fs::path& folder) {
    if (const char* now = std::getenv(kName)) before_ = now;
    ::setenv(kName, folder.c_str(), 1);
  }
  ~RuntimeFolder() { before_.empty() ? ::unsetenv(kName) : ::setenv(kName, before_.c_str(), 1); }

 private:
  static constexpr const char* kName = "XDG_RUNTIME_DIR";
  std::string before_;
};

TEST(DefaultEndpoint, LiesInTheUsersRunTimeFolder) {
  const TemporaryFolder folder;
  ASSERT_EQ(::chmod(folder.path().c_str(), 0700), 0);
  const RuntimeFolder runtime(folder.path());
  EXPECT_EQ(default_endpoint("needle"), "ipc://" + (folder / "trocar-needle").string());
}

TEST(DefaultEndpoint, AvoidsAFolderOpenToOthers) {
  const TemporaryFolder folder;
  ASSERT_EQ(::chmod(folder.path().c_str(), 0755), 0);
  const RuntimeFolder runtime(folder.path());
  EXPECT_FALSE(default_endpoint("needle").starts_with("ipc://" + folder.path().string()));
}

TEST(PrivateFolder, IsCreatedForTheUserOnly) {
  const TemporaryFolder folder;
  const fs::path made = folder / "run";
  ASSERT_TRUE(detail::make_private_folder(made));
  struct stat status {};
  ASSERT_EQ(::stat(made.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0700u);
  EXPECT_TRUE(detail::make_private_folder(made)) << "the second time it is there";
}

TEST(PrivateFolder, OpenFolderLinkAndFileAreRefused) {
  const TemporaryFolder folder;
  const fs::path open = folder / "open", link = folder / "link", target = folder / "target";
  fs::create_directory(open);
  ASSERT_EQ(::chmod(open.c_str(), 0750), 0);
  EXPECT_FALSE(detail::make_private_folder(open));
  ASSERT_TRUE(detail::make_private_folder(target));
  fs::create_directory_symlink(target, link);
  EXPECT_FALSE(detail::make_private_folder(link));
  EXPECT_FALSE(detail::make_private_folder(folder / "no" / "such"));
}

TEST(PrivateFolder, RefusesAFolderOfAnotherUser) {
  if (::geteuid() == 0) {
    const TemporaryFolder folder;
    constexpr uid_t kNobody = 65534;
    ASSERT_EQ(::chown(folder.path().c_str(), kNobody, kNobody), 0);
    EXPECT_FALSE(detail::check_private_folder(folder.path()));
  } else {
    EXPECT_FALSE(detail::check_private_folder("/root"));
  }
}

}  // namespace
}  // namespace trocar::link
