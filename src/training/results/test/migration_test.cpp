#include <map>

#include "database/statements.h"
#include "results/detail/schema.h"
#include "results/notes.h"
#include "results_lab.h"

namespace trocar::results {
namespace {

class Migration : public ResultsTest {
 protected:
  /// A database of the first schema, beside that of the test.
  void make_old() {
    if (GetParam() == "postgresql") {
      Repository owner = *Repository::open(owner_url_);
      ASSERT_TRUE(owner.database().run("cannot be emptied", [](soci::session& session) {
        session
            << "DO $$ DECLARE old record; BEGIN FOR old IN SELECT tablename FROM pg_tables WHERE schemaname = 'public'"
               " LOOP EXECUTE format('DROP TABLE %I CASCADE', old.tablename); END LOOP; END $$";
      }));
      url_ = owner_url_;
    } else {
      url_ = {folder_ / "old.sqlite", {}};
    }
    auto old = database::Database::open(url_, database::Missing::kCreate);
    ASSERT_TRUE(old) << old.error().text();
    const auto migrated = database::migrate(*old, kApplicationId, detail::migrations().first(1));
    ASSERT_TRUE(migrated) << migrated.error().text();
    const auto filled = old->transaction("cannot be filled", [this](soci::session& session) { fill(session); });
    ASSERT_TRUE(filled) << filled.error().text();
  }

  /// `score` empty, `punctures` of the skin -1: not measured.
  void add_old(soci::session& session, const std::string& id, int state, std::optional<double> score, int punctures,
               const std::string& reason) {
    soci::indicator has_score = score ? soci::i_ok : soci::i_null;
    double value = score.value_or(0.0), count = punctures;
    session << "INSERT INTO attempts (id, person_id, case_id, task, level, operator, station, started_s, state, score,"
               " is_passed, duration_s, program_version) VALUES (:i, 'p', 1, 't', 'exam', '', '', 0, :s, :v, 1, 1, '')",
        soci::use(id), soci::use(state), soci::use(value, has_score);
    long long sequence = 0;
    session << "SELECT sequence FROM attempts WHERE id = :i", soci::use(id), soci::into(sequence);
    if (punctures >= 0)
      session << "INSERT INTO attempt_metrics (sequence, metric_id, value) VALUES (:q, 1, :v)", soci::use(sequence),
          soci::use(count);
    const std::string verdict =
        R"({"fails":[],"hints":[{"at_s":null,"text":"not: \"the needle never touched the skin\""}],"not_scored":")" +
        reason + "\"}";
    session << "INSERT INTO attempt_details (sequence, verdict, trace) VALUES (:q, :v, '')", soci::use(sequence),
        soci::use(verdict);
  }

  void fill(soci::session& session) {
    session << "INSERT INTO people VALUES ('p', 'Anna', 'anna', 0, 0, NULL, '', 0, 0, 0)";
    session << "INSERT INTO cases (task, patient, seed, patient_hash, difficulty) VALUES ('t', 'a', '1', '', 0)";
    session << "INSERT INTO metrics (name, unit) VALUES ('skin_punctures', '1')";
    add_old(session, "scored", 1, 50.0, 1, "");
    add_old(session, "not fired", 1, {}, 1, "the gun was not fired");
    add_old(session, "in the air", 1, {}, 0, "any reason");
    add_old(session, "older, not fired", 1, {}, -1, "the gun was not fired");
    add_old(session, "older, in the air", 1, {}, -1, "the needle never touched the skin");
    add_old(session, "older, skin", 1, {}, -1, "the needle did not pierce the skin");
    add_old(session, "cut", 2, {}, 1, "");
    add_old(session, "running", 0, {}, -1, "");
  }
};
TROCAR_BOTH_DATABASES(Migration);

TEST_P(Migration, DistinguishesUnscoredFromUnstartedAttempts) {
  make_old();
  if (HasFatalFailure()) return;
  Repository repository = open();
  const auto attempts = list_attempts(repository, {});
  ASSERT_TRUE(attempts) << attempts.error().text();
  std::map<std::string, State> states;
  for (const Attempt& attempt : *attempts) {
    states[attempt.id] = attempt.state;
    EXPECT_EQ(attempt.is_passed, attempt.id == "scored" || !has_ended(attempt.state)) << attempt.id;
  }
  EXPECT_EQ(states, (std::map<std::string, State>{{"scored", State::kFinished},
                                                  {"not fired", State::kUnscored},
                                                  {"in the air", State::kNeverBegan},
                                                  {"older, not fired", State::kUnscored},
                                                  {"older, in the air", State::kNeverBegan},
                                                  {"older, skin", State::kNeverBegan},
                                                  {"cut", State::kInterrupted},
                                                  {"running", State::kRunning}}));
  EXPECT_TRUE(add_note(repository, "scored", "huber", "text", Seconds())) << "the newest table";
  const auto summaries = summarise_tasks(repository);
  ASSERT_TRUE(summaries) << summaries.error().text();
  EXPECT_EQ(learning::counts_text(summaries->front().counts),
            "3 attempts counted (2 ended without a result), 5 left out: 3 never began, 1 was lost to a crash, 1 is not "
            "over");
}

}  // namespace
}  // namespace trocar::results
