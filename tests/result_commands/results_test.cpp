// trocar results, and trocar run --person: people, attempts, session files and CSV in a database.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "cli/program.h"
#include "cli/short_session.h"
#include "link/client/server_process.h"
#include "storage/session_file.h"

namespace trocar::cli_test {
namespace {
namespace fs = std::filesystem;

class Results : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return "'" + (folder_ / name) + "'"; }
  Outcome results(const std::string& arguments) const {
    return trocar("results --db " + file("r.sqlite") + " " + arguments);
  }
  void add_anna() const { ASSERT_EQ(results("add 'Anna Meier' --course 'Course 1'").exit_status, 0); }

  TemporaryFolder folder_;
};

TEST_F(Results, AreImportedListedAndExported) {
  add_anna();
  write_session(folder_ / "a.session", {.score = 91.0});
  write_session(folder_ / "b.session", {.started_utc = "2026-01-03T10:11:12Z", .seed = 2, .score = 42.0});
  const Outcome imported = results("import " + file("a.session") + " " + file("b.session") + " --person 'anna meier'");
  ASSERT_EQ(imported.exit_status, 0) << imported.err;
  EXPECT_NE(imported.out.find("2 attempts added"), std::string::npos) << imported.out;
  EXPECT_NE(results("import " + file("a.session") + " --person 'Anna Meier'").out.find("1 were there already"),
            std::string::npos);
  EXPECT_EQ(json_of(trocar("learn --json --person 'Anna Meier' --db " + file("r.sqlite")))["attempts"], 2);
  const config::Json json = json_of(results("list --json"));
  ASSERT_EQ(json["attempts"].size(), 2u);
  EXPECT_EQ(json["attempts"][0]["score"], 91.0);
  EXPECT_EQ(json["attempts"][0]["person"], "Anna Meier");
  EXPECT_EQ(json["attempts"][0]["case"], 1);
  EXPECT_EQ(json_of(results("people --json"))["people"][0]["attempts"], 2);
  // The session file comes back byte by byte.
  ASSERT_EQ(
      results("export --attempt " + json["attempts"][0]["id"].get<std::string>() + " --out " + file("back.session"))
          .exit_status,
      0);
  EXPECT_EQ(read_text(folder_ / "back.session"), read_text(folder_ / "a.session"));
  // Into another database, and on to nobody's loss.
  ASSERT_EQ(results("export --csv " + file("all.csv")).exit_status, 0);
  const Outcome other = trocar("results --db " + file("other.sqlite") + " import " + file("all.csv"));
  EXPECT_NE(other.out.find("2 attempts added"), std::string::npos) << other.err;
}

TEST_F(Results, OptionsThatContradictAPersonAreRefused) {
  add_anna();
  write_session(folder_ / "a.session", {.score = 91.0});
  for (const char* option : {"--group expert", "--simulated", "--course Other"}) {
    const Outcome refused = results("import " + file("a.session") + " --person ' anna  Meier' " + option);
    EXPECT_EQ(refused.exit_status, 2) << option;
    EXPECT_NE(refused.err.find("\"Anna Meier\" is a trainee of Course 1"), std::string::npos) << refused.err;
    EXPECT_TRUE(json_of(results("list --json"))["attempts"].empty()) << option;
  }
  for (const char* option : {"--group trainee", "--course 'course 1'", ""})
    EXPECT_EQ(results("import " + file("a.session") + " --person 'Anna Meier' " + option).exit_status, 0) << option;
}

TEST_F(Results, ReportCountedAndExcludedAttempts) {
  add_anna();
  std::string files;
  const auto write = [&](const std::string& name, const ShortSession& session) {
    write_session(folder_ / name, session);
    files += " " + file(name);
  };
  write("passed.session", {.score = 91.0});
  for (int n = 0; n < 2; ++n)
    write("u" + std::to_string(n) + ".session",
          {.started_utc = "2026-01-04T10:00:0" + std::to_string(n) + "Z", .not_scored = "the gun was not fired"});
  write("air.session", {.started_utc = "2026-01-05T10:00:00Z", .not_scored = "in the air", .punctures = 0.0});
  write("cut.session", {.started_utc = "2026-01-06T10:00:00Z", .is_cut = true});
  const std::string counted =
      "3 attempts counted (2 ended without a result), 2 left out: 1 never began, 1 was lost to a crash";
  const Outcome imported = results("import" + files + " --person 'Anna Meier'");
  EXPECT_NE(imported.out.find("of the added: " + counted), std::string::npos) << imported.out << imported.err;
  for (const std::string command : {"list", "people", "curve --person 'Anna Meier' --task liver-biopsy",
                                    "validity --task liver-biopsy", "proficiency --task liver-biopsy"}) {
    const Outcome outcome = results(command);
    EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find(counted), std::string::npos) << command << "\n" << outcome.out;
  }
  EXPECT_NE(results("curve --person 'Anna Meier' --task liver-biopsy").out.find("1 of 3 passed"), std::string::npos);
  // Out as CSV and in again, nothing is lost.
  ASSERT_EQ(results("export --csv " + file("a.csv")).exit_status, 0);
  const std::string other = "results --db " + file("other.sqlite") + " ";
  const Outcome read = trocar(other + "import " + file("a.csv"));
  EXPECT_NE(read.out.find("5 attempts added"), std::string::npos) << read.out << read.err;
  ASSERT_EQ(trocar(other + "export --csv " + file("b.csv")).exit_status, 0);
  EXPECT_EQ(read_text(folder_ / "b.csv"), read_text(folder_ / "a.csv"));
  EXPECT_NE(results("import " + file("a.csv")).out.find("0 attempts added, 5 were there already"), std::string::npos);
}

TEST_F(Results, ImportGoodFilesBesideABadOne) {
  add_anna();
  write_session(folder_ / "a.session", {.score = 91.0});
  ASSERT_EQ(results("import " + file("a.session") + " --person 'Anna Meier'").exit_status, 0);
  ASSERT_EQ(results("export --csv " + file("a.csv")).exit_status, 0);
  std::ofstream(folder_ / "wrong.csv") << "a,b\r\n1,2\r\n";
  const Outcome both =
      trocar("results --db " + file("other.sqlite") + " import " + file("wrong.csv") + " " + file("a.csv"));
  EXPECT_EQ(both.exit_status, 1);
  EXPECT_NE(both.out.find("1 attempts added"), std::string::npos) << both.out;
  EXPECT_NE(both.err.find("there is no column \"a\""), std::string::npos) << both.err;
  EXPECT_NE(both.err.find("1 of 2 files were not imported"), std::string::npos) << both.err;
}

TEST_F(Results, DeleteAPersonOnlyAfterConfirmation) {
  add_anna();
  write_session(folder_ / "a.session", {});
  ASSERT_EQ(results("import " + file("a.session") + " --person 'Anna Meier'").exit_status, 0);
  expect_refused(results("delete --person 'Anna Meier'"), 2, "1 attempts, 1 recordings");
  EXPECT_EQ(json_of(results("list --json"))["attempts"].size(), 1u);
  ASSERT_EQ(results("delete --person 'Anna Meier' --yes").exit_status, 0);
  EXPECT_EQ(json_of(results("people --json"))["people"].size(), 0u);
}

TEST_F(Results, RefuseBadInputInOneLine) {
  expect_refused(results("people"), 1, "no such database");
  expect_refused(trocar("results --db mysql://a/b people"), 2, "no kind of database");
  expect_refused(trocar("results --db postgresql://h people"), 2, "names no database");
  expect_refused(trocar("results --db postgresql://a:secret@127.0.0.1:1/b people"), 1, "no server answers");
  EXPECT_EQ(trocar("results --db postgresql://a:secret@127.0.0.1:1/b people").err.find("secret"), std::string::npos);
  add_anna();
  expect_refused(results("add 'ANNA meier'"), 2, "the name is taken");
  expect_refused(results("add ' '"), 2, "is empty");
  expect_refused(results("add Ben --group boss"), 2, "unknown group");
  expect_refused(results("list --person Nobody"), 2, "no such person");
  expect_refused(results("change 'Anna Meier'"), 2, "nothing to change");
  expect_refused(results("import " + file("none.session")), 2, "no such file");
  std::ofstream(folder_ / "text.session") << "hello";
  expect_refused(results("import " + file("text.session") + " --person 'Anna Meier'"), 1, "is not a session");
  write_session(folder_ / "a.session", {});
  expect_refused(results("import " + file("a.session")), 2, "names no person");
  expect_refused(trocar("results --db " + file("a.session") + " people"), 1, "belongs to another program");
  expect_refused(results("export --attempt 0123 --out " + file("x.session")), 2, "no such attempt");
  EXPECT_FALSE(fs::exists(folder_ / "x.session"));
}

TEST_F(Results, RecordARunForItsPerson) {
  add_anna();
  const std::string run =
      "run liver-biopsy --patient abdomen --operator constant-velocity:60 --out " + file("run.session");
  expect_refused(trocar(run + " --db " + file("r.sqlite")), 2, "for a person only");
  expect_refused(trocar(run + " --person Nobody --db " + file("r.sqlite")), 2, "no such person");
  ASSERT_EQ(trocar(run + " --person 'Anna Meier' --db " + file("r.sqlite")).exit_status, 0);
  const config::Json json = json_of(results("list --json"));
  ASSERT_EQ(json["attempts"].size(), 1u);
  EXPECT_EQ(json["attempts"][0]["person"], "Anna Meier");
  EXPECT_EQ(json["attempts"][0]["state"], "finished");
}

TEST_F(Results, KeepAllTicksOfAKilledStation) {
  const char* programs = std::getenv("TROCAR_BIN_DIR");
  ASSERT_NE(programs, nullptr) << "run the test through ctest";
  add_anna();
  const std::string session = folder_ / "live.session";
  auto station =
      link::ServerProcess::start(fs::path(programs) / "trocar",
                                 {"run", "liver-biopsy", "--patient", "abdomen", "--operator", "expert", "--realtime",
                                  "--person", "Anna Meier", "--db", folder_ / "r.sqlite", "--out", session},
                                 folder_ / "log");
  ASSERT_TRUE(station.has_value()) << station.error().text();
  // What another program can read while the station runs must survive its death; the station commits every half second.
  std::size_t seen = 0;
  for (int n = 0; n < 3000 && seen < 1500; ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (const auto running = storage::load_session(session)) seen = running->samples.size();
  }
  ASSERT_GE(seen, 1500u) << read_text(folder_ / "log");
  EXPECT_EQ(json_of(results("list --json"))["attempts"][0]["state"], "running");
  ::kill(station->pid(), SIGKILL);
  const Outcome imported = results("import " + file("live.session"));
  EXPECT_NE(imported.out.find("1 attempts added"), std::string::npos) << imported.err;
  const config::Json json = json_of(results("list --json"));
  ASSERT_EQ(json["attempts"].size(), 1u);
  EXPECT_EQ(json["attempts"][0]["state"], "interrupted");
  EXPECT_GE(json["attempts"][0]["duration_s"], static_cast<double>(seen - 1) / 1000.0 - 1e-6);
}

}  // namespace
}  // namespace trocar::cli_test
