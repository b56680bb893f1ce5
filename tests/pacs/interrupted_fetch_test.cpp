// A fetch that is interrupted or killed, and the next one to the same place.
#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>

#include "cli/program.h"
#include "dicom/pacs/testing/made_object.h"
#include "pacs/fake_pacs.h"
#include "pacs/from_fake_pacs.h"
#include "pacs/sockets.h"

namespace trocar::pacs_test {
namespace {
namespace fs = std::filesystem;
namespace made = dicom::testing;

using cli_test::Outcome;

/// The program gets a signal in the middle of the second object.
class Interrupted : public FromFakePacs {
 protected:
  Outcome run_with_signal(const std::string& signal) {
    const FakeServer server({lists_series(3), answers_get([&](int socket, int, int ct) {
                               send_object(socket, ct, made::made_ct(0).bytes());
                               send_all(socket, part(ct, true, true, store_request().bytes()));
                               send_all(socket, part(ct, false, false, made::made_ct(1).bytes().substr(0, 3000)));
                               cli_test::run_shell("kill -" + signal + " $(cat '" + (pid_ / "pid") + "')");
                               wait_for_close(socket);
                             })});
    return cli_test::trocar(arguments(server.port()), "echo $$ > '" + (pid_ / "pid") + "'; exec");
  }

  cli_test::TemporaryFolder pid_;
};

TEST_F(Interrupted, FetchLeavesNothing) {
  const Outcome outcome = run_with_signal("TERM");  // a shell's job in the background ignores INT
  EXPECT_EQ(outcome.exit_status, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("interrupted: nothing was written"), std::string::npos) << outcome.err;
  EXPECT_TRUE(folder_.is_empty());
}

TEST_F(Interrupted, KilledProgramLeavesNoIdentity) {
  const Outcome outcome = run_with_signal("KILL");
  EXPECT_NE(outcome.exit_status, 0);
  EXPECT_FALSE(fs::exists(folder_.path() / "a"));
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
    if (!entry.is_regular_file()) continue;
    ++files;
    const std::string bytes = cli_test::read_text(entry.path().string());
    for (const std::string& text : made::identifying_texts())
      EXPECT_EQ(bytes.find(text), std::string::npos) << text << " in " << entry.path();
  }
  EXPECT_EQ(files, 1) << "the first object, anonymised, in the temporary folder";
}

TEST_F(Interrupted, NextFetchRemovesTheRestOfAKilledOne) {
  EXPECT_NE(run_with_signal("KILL").exit_status, 0);
  ASSERT_FALSE(folder_.is_empty());
  const FakeServer server({lists_series(2), sends_two_slices()});
  const Outcome outcome = cli_test::trocar(arguments(server.port()));
  EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  const fs::directory_iterator entries(folder_.path());
  EXPECT_EQ(std::distance(entries, fs::directory_iterator()), 1) << "the fetched folder alone";
  EXPECT_TRUE(fs::exists(folder_.path() / "a" / "series_001_CT" / "00002.dcm"));
}

TEST_F(Interrupted, NextFetchKeepsARunningOne) {
  const FakeServer other({lists_series(2), sends_two_slices()});
  Outcome second;
  const FakeServer server({lists_series(2), answers_get([&](int socket, int request, int ct) {
                             send_object(socket, ct, made::made_ct(0).bytes());
                             second = cli_test::trocar(arguments(other.port()));
                             fs::rename(folder_.path() / "a", folder_.path() / "b");
                             send_object(socket, ct, made::made_ct(1).bytes());
                             end_get(socket, request);
                           })});
  const Outcome first = cli_test::trocar(arguments(server.port()));
  EXPECT_EQ(second.exit_status, 0) << second.err;
  EXPECT_EQ(first.exit_status, 0) << first.err;
  for (const char* name : {"a", "b"})
    EXPECT_TRUE(fs::exists(folder_.path() / name / "series_001_CT" / "00002.dcm")) << name;
}

}  // namespace
}  // namespace trocar::pacs_test
