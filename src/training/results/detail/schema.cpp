#include "results/detail/schema.h"

#include <vector>

namespace trocar::results::detail {
namespace {

// Times are seconds since 1970, UTC; truth values 0 or 1; ids of rows 32 hexadecimal digits.
database::Migration version_1() {
  return {
      "CREATE TABLE settings (name TEXT PRIMARY KEY, value TEXT NOT NULL)",
      "CREATE TABLE courses (id TEXT PRIMARY KEY, name TEXT NOT NULL, name_key TEXT NOT NULL UNIQUE)",
      "CREATE TABLE people (id TEXT PRIMARY KEY, name TEXT NOT NULL, name_key TEXT NOT NULL UNIQUE,"
      " is_expert INTEGER NOT NULL, is_simulated INTEGER NOT NULL, course_id TEXT REFERENCES courses (id),"
      " pin_hash TEXT NOT NULL, pin_failures INTEGER NOT NULL, pin_failed_s BIGINT NOT NULL, added_s BIGINT NOT NULL)",
      "CREATE INDEX people_of_course ON people (course_id)",
      "CREATE TABLE cases (id {sequence}, task TEXT NOT NULL, patient TEXT NOT NULL, seed TEXT NOT NULL,"
      " patient_hash TEXT NOT NULL, difficulty INTEGER NOT NULL, UNIQUE (task, patient, seed, patient_hash))",
      "CREATE TABLE attempts (sequence {sequence}, id TEXT NOT NULL UNIQUE,"
      " person_id TEXT NOT NULL REFERENCES people (id) ON DELETE CASCADE, case_id BIGINT NOT NULL REFERENCES cases "
      "(id),"
      " task TEXT NOT NULL, level TEXT NOT NULL, operator TEXT NOT NULL, station TEXT NOT NULL,"
      " started_s BIGINT NOT NULL, state INTEGER NOT NULL, score DOUBLE PRECISION, is_passed INTEGER NOT NULL,"
      " duration_s DOUBLE PRECISION NOT NULL, program_version TEXT NOT NULL)",
      "CREATE INDEX attempts_of_person ON attempts (person_id, task, sequence, score, is_passed, started_s)",
      "CREATE INDEX attempts_of_task ON attempts (task, sequence)",
      "CREATE INDEX attempts_of_case ON attempts (case_id, score)",
      // Verdict, hints and trace as JSON: read for one attempt at a time.
      "CREATE TABLE attempt_details (sequence BIGINT PRIMARY KEY REFERENCES attempts (sequence) ON DELETE CASCADE,"
      " verdict TEXT NOT NULL, trace TEXT NOT NULL)",
      "CREATE TABLE attempt_parts (sequence BIGINT NOT NULL REFERENCES attempts (sequence) ON DELETE CASCADE,"
      " part TEXT NOT NULL, points DOUBLE PRECISION NOT NULL, max_points DOUBLE PRECISION NOT NULL, value TEXT NOT "
      "NULL,"
      " PRIMARY KEY (sequence, part))",
      "CREATE TABLE metrics (id {sequence}, name TEXT NOT NULL UNIQUE, unit TEXT NOT NULL)",
      "CREATE TABLE attempt_metrics (sequence BIGINT NOT NULL REFERENCES attempts (sequence) ON DELETE CASCADE,"
      " metric_id BIGINT NOT NULL REFERENCES metrics (id), value DOUBLE PRECISION NOT NULL,"
      " PRIMARY KEY (metric_id, sequence))",
      "CREATE INDEX metrics_of_attempt ON attempt_metrics (sequence)",
      // The session file, as it was written.
      "CREATE TABLE recordings (sequence BIGINT PRIMARY KEY REFERENCES attempts (sequence) ON DELETE CASCADE,"
      " bytes {bytes} NOT NULL)",
      "CREATE TABLE forms (id TEXT PRIMARY KEY, token TEXT NOT NULL UNIQUE, title TEXT NOT NULL, intro TEXT NOT NULL,"
      " is_open INTEGER NOT NULL, changed_s BIGINT NOT NULL)",
      "CREATE TABLE form_items (id TEXT PRIMARY KEY, form_id TEXT NOT NULL REFERENCES forms (id) ON DELETE CASCADE,"
      " position INTEGER NOT NULL, kind INTEGER NOT NULL, text TEXT NOT NULL, is_required INTEGER NOT NULL,"
      " is_retired INTEGER NOT NULL)",
      "CREATE INDEX items_of_form ON form_items (form_id, position)",
      "CREATE TABLE responses (id TEXT PRIMARY KEY, form_id TEXT NOT NULL REFERENCES forms (id) ON DELETE CASCADE,"
      " person_id TEXT REFERENCES people (id) ON DELETE CASCADE, submitted_s BIGINT NOT NULL)",
      "CREATE INDEX responses_to_form ON responses (form_id, submitted_s)",
      "CREATE INDEX responses_of_person ON responses (person_id)",
      "CREATE TABLE answers (response_id TEXT NOT NULL REFERENCES responses (id) ON DELETE CASCADE,"
      " item_id TEXT NOT NULL REFERENCES form_items (id) ON DELETE CASCADE, points INTEGER NOT NULL, text TEXT NOT "
      "NULL,"
      " PRIMARY KEY (item_id, response_id))",
      "CREATE INDEX answers_of_response ON answers (response_id)",
      "CREATE TABLE accounts (id TEXT PRIMARY KEY, name TEXT NOT NULL, name_key TEXT NOT NULL UNIQUE,"
      " is_admin INTEGER NOT NULL, password_hash TEXT NOT NULL, added_s BIGINT NOT NULL)",
      "CREATE TABLE web_sessions (token_hash TEXT PRIMARY KEY,"
      " account_id TEXT NOT NULL REFERENCES accounts (id) ON DELETE CASCADE, csrf_token TEXT NOT NULL,"
      " begun_s BIGINT NOT NULL, used_s BIGINT NOT NULL)",
      "CREATE INDEX web_sessions_of_account ON web_sessions (account_id)",
  };
}

// Attempts that ended without a score were "finished" (1); now 3: the needle was in the body, 4: it never was. By the
// punctures of the skin, or (older sessions) by the reason why it was not scored; "_" stands for the colon.
database::Migration version_2() {
  return {
      "UPDATE attempts SET is_passed = 0, state = CASE"
      " WHEN EXISTS (SELECT 1 FROM attempt_metrics v JOIN metrics m ON m.id = v.metric_id"
      " WHERE v.sequence = attempts.sequence AND m.name = 'skin_punctures' AND v.value > 0) THEN 3"
      " WHEN EXISTS (SELECT 1 FROM attempt_metrics v JOIN metrics m ON m.id = v.metric_id"
      " WHERE v.sequence = attempts.sequence AND m.name = 'skin_punctures') THEN 4"
      " WHEN EXISTS (SELECT 1 FROM attempt_details d WHERE d.sequence = attempts.sequence"
      " AND (d.verdict LIKE '%\"not_scored\"_\"the needle never touched the skin\"%'"
      " OR d.verdict LIKE '%\"not_scored\"_\"the needle did not pierce the skin\"%')) THEN 4"
      " ELSE 3 END WHERE state = 1 AND score IS NULL",
      "DROP INDEX attempts_of_person",
      "CREATE INDEX attempts_of_person ON attempts (person_id, task, sequence, score, is_passed, started_s, state)",
  };
}

// Minutes of instructors, as they were entered.
database::Migration version_3() {
  return {
      "CREATE TABLE teaching (sequence {sequence}, person_id TEXT NOT NULL REFERENCES people (id) ON DELETE CASCADE,"
      " task TEXT NOT NULL, minutes DOUBLE PRECISION NOT NULL, entered_s BIGINT NOT NULL)",
      "CREATE INDEX teaching_of_task ON teaching (task, person_id)",
  };
}

// From where accounts have logged in.
database::Migration version_4() {
  return {
      "CREATE TABLE login_clients (account_id TEXT NOT NULL REFERENCES accounts (id) ON DELETE CASCADE,"
      " client TEXT NOT NULL, used_s BIGINT NOT NULL, PRIMARY KEY (account_id, client))",
  };
}

// Notes of instructors to attempts. `number` is the order of writing.
database::Migration version_5() {
  return {
      "CREATE TABLE notes (number {sequence}, id TEXT NOT NULL UNIQUE,"
      " sequence BIGINT NOT NULL REFERENCES attempts (sequence) ON DELETE CASCADE,"
      " author TEXT NOT NULL, text TEXT NOT NULL, written_s BIGINT NOT NULL)",
      "CREATE INDEX notes_of_attempt ON notes (sequence)",
  };
}

}  // namespace

std::span<const database::Migration> migrations() {
  static const std::vector<database::Migration> kAll{version_1(), version_2(), version_3(), version_4(), version_5()};
  return kAll;
}

}  // namespace trocar::results::detail
