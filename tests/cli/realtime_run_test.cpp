// trocar run --realtime: through servers of its own, and what it says when servers are not there.
#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <thread>

#include "cli/program.h"
#include "link/client/server_process.h"
#include "storage/session_file.h"

namespace trocar::cli_test {
namespace {
namespace fs = std::filesystem;

constexpr const char* kRun = "run liver-biopsy --patient abdomen --operator constant-velocity:60 --realtime ";

TEST(RealtimeRun, StartsTwoServersAndReportsTheirFigures) {
  const TemporaryFolder folder;
  const config::Json json = json_of(trocar(kRun + ("--json --out '" + (folder / "live.session") + "'")));
  EXPECT_EQ(json["target_reached"], true);
  ASSERT_EQ(json["punctures"].size(), 3u);
  ASSERT_EQ(json["servers"].size(), 2u);
  EXPECT_EQ(json["servers"][0]["tool"], "needle");
  EXPECT_EQ(json["servers"][1]["tool"], "probe");
  for (const config::Json& server : json["servers"]) {
    EXPECT_EQ(server["device"], "virtual:premium");
    EXPECT_EQ(server["wanted_hz"], 1000.0);
    EXPECT_GT(server["ticks_received"], 1000);
    for (const char* name : {"achieved_hz", "periods_served", "lateness", "ticks_missing"})
      EXPECT_TRUE(server.contains(name)) << name;
  }
  const auto session = storage::load_session(folder / "live.session");
  ASSERT_TRUE(session.has_value()) << session.error().text();
  EXPECT_EQ(session->samples.size(), json["ticks"].get<std::size_t>());
}

TEST(RealtimeRun, ReportsAServerThatDoesNotAnswer) {
  const TemporaryFolder folder;
  const Outcome outcome = trocar(kRun + ("--patience 0.2 --endpoint 'ipc://" + (folder / "nobody") + "' --out '" +
                                         (folder / "live.session") + "'"));
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_EQ(line_count(outcome.err.substr(outcome.err.find("error: "))), 1) << outcome.err;
  EXPECT_NE(outcome.err.find("start trocar-hapticd"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(folder / "live.session"));
}

TEST(RealtimeRun, RefusesContradictoryOptionsAsUsageErrors) {
  const TemporaryFolder folder;
  const std::string out = " --out '" + (folder / "live.session") + "'";
  const std::string in_process = "run liver-biopsy --patient abdomen --operator expert ";
  for (const std::string& arguments :
       {in_process + "--endpoint ipc:///tmp/needle", kRun + std::string("--endpoint needle"),
        kRun + std::string("--endpoint tcp://192.0.2.1:5571"),
        kRun + std::string("--endpoint ipc:///tmp/needle --device omni"), kRun + std::string("--keys client.key")}) {
    const Outcome outcome = trocar(arguments + out);
    EXPECT_EQ(outcome.exit_status, 2) << arguments << outcome.err;
    EXPECT_EQ(line_count(outcome.err), 1) << outcome.err;
  }
  EXPECT_TRUE(folder.is_empty());
}

/// Size of a session that is being written, all its files; 0: none yet.
std::uintmax_t written_bytes(const std::string& session) {
  std::uintmax_t bytes = 0;
  for (const char* tail : {"", "-wal"}) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(session + tail, error);
    if (!error) bytes += size;
  }
  return bytes;
}

TEST(RealtimeRun, KeepsTheSessionWhenTheServerIsKilled) {
  const char* programs = std::getenv("TROCAR_BIN_DIR");
  ASSERT_NE(programs, nullptr) << "run the test through ctest";
  const TemporaryFolder folder;
  const std::string session = folder / "live.session";
  const std::string url = "ipc://" + (folder / "needle");
  auto server = link::ServerProcess::start(
      fs::path(programs) / "trocar-hapticd",
      {"--endpoint", url, "--priority", "0", "--flight-records", folder.path().string()}, folder / "log");
  ASSERT_TRUE(server.has_value()) << server.error().text();

  std::atomic<bool> has_ended = false;
  Outcome outcome;
  std::thread run([&] {
    outcome = trocar("run liver-biopsy --patient abdomen --operator expert --realtime --patience 3 --endpoint '" + url +
                     "' --out '" + session + "'");
    has_ended = true;
  });
  // Half a second of ticks, at more than 100 bytes each, is in the file when it is committed for the second time.
  constexpr std::uintmax_t kUnderWay_bytes = 200'000;
  while (!has_ended && written_bytes(session) < kUnderWay_bytes)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ::kill(server->pid(), SIGKILL);
  run.join();
  EXPECT_EQ(outcome.exit_status, 1) << outcome.out;
  EXPECT_NE(outcome.err.find("the server has not responded"), std::string::npos) << outcome.err;
  const auto kept = storage::load_session(session);
  ASSERT_TRUE(kept.has_value()) << kept.error().text();
  EXPECT_GT(kept->samples.size(), 400u);
  EXPECT_FALSE(kept->outcome.has_value());
}

}  // namespace
}  // namespace trocar::cli_test
