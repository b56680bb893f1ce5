#include "results/notes.h"

#include <fstream>

#include "config/csv.h"
#include "results/attempt.h"
#include "results/people.h"
#include "results/repository.h"
#include "results_lab.h"

namespace trocar::results {
namespace {

class Notes : public ResultsTest {};
TROCAR_BOTH_DATABASES(Notes);

TEST_P(Notes, KeepWritingOrderAuthorAndTime) {
  const AttemptRecord one = attempt(add("Anna").id, 50.0);
  put(one);
  const std::string hostile = "'; DROP TABLE notes; --\n<b>ü</b>";
  const auto first = add_note(*repository_, one.attempt.id, "Dr. Weber", "  " + hostile + " ", kNow);
  ASSERT_TRUE(first) << first.error().text();
  ASSERT_TRUE(add_note(*repository_, one.attempt.id, "huber", "second", kNow - std::chrono::hours(1)));
  const auto notes = list_notes(*repository_, one.attempt.id);
  ASSERT_TRUE(notes);
  ASSERT_EQ(notes->size(), 2U);
  EXPECT_EQ(notes->front().text, hostile);
  EXPECT_EQ(notes->front().author, "Dr. Weber");
  EXPECT_EQ(notes->front().written, kNow);
  EXPECT_EQ(notes->front().attempt_id, one.attempt.id);
  EXPECT_EQ(notes->back().author, "huber");
  EXPECT_EQ(find_note(*repository_, first->id).value()->text, hostile);
  EXPECT_FALSE(find_note(*repository_, "unknown").value());
  ASSERT_TRUE(delete_note(*repository_, first->id));
  EXPECT_FALSE(delete_note(*repository_, first->id));
  EXPECT_EQ(list_notes(*repository_, one.attempt.id)->size(), 1U);
}

TEST_P(Notes, DeletionIsVisibleToOthersAndErasesTheBytes) {
  const AttemptRecord one = attempt(add("Anna").id, 50.0);
  put(one);
  const std::string text = "unmistakable text";
  const auto is_in_a_file = [&] {
    for (const char* ending : {"", "-wal", "-journal"}) {
      std::ifstream file(folder_ / (std::string("results.sqlite") + ending), std::ios::binary);
      if (std::string((std::istreambuf_iterator<char>(file)), {}).find(text) != std::string::npos) return true;
    }
    return false;
  };
  const auto note = add_note(*repository_, one.attempt.id, "huber", text, kNow);
  ASSERT_TRUE(note) << note.error().text();
  EXPECT_EQ(is_in_a_file(), GetParam() == "sqlite");
  EXPECT_FALSE(delete_note(*repository_, "unknown"));
  const std::string before = last_deletion(*repository_).value();
  ASSERT_TRUE(delete_note(*repository_, note->id));
  EXPECT_NE(last_deletion(*repository_).value(), before);
  EXPECT_FALSE(is_in_a_file());
}

TEST_P(Notes, NeedAnAttemptAndAText) {
  const AttemptRecord one = attempt(add("Anna").id, 50.0);
  put(one);
  for (const std::string& bad : {std::string(), std::string(" \n"), std::string("a\x01"), std::string("\xff"),
                                 std::string(kMaxNoteCharacters + 1, 'x')}) {
    const auto refused = add_note(*repository_, one.attempt.id, "huber", bad, kNow);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().exit_status, 2);
  }
  EXPECT_TRUE(add_note(*repository_, one.attempt.id, "huber", std::string(kMaxNoteCharacters, 'x'), kNow));
  EXPECT_FALSE(add_note(*repository_, make_id(), "huber", "text", kNow));
}

TEST_P(Notes, AreCountedExportedAndDeletedWithThePerson) {
  const Person anna = add("=Anna", Group::kTrainee, "Spring"), ben = add("Ben");
  const AttemptRecord first = attempt(anna.id, 50.0), second = attempt(anna.id, 60.0), other = attempt(ben.id, 70.0);
  const std::int64_t sequence = put(first);
  put(second);
  put(other);
  for (const char* text : {"one", "two"}) ASSERT_TRUE(add_note(*repository_, first.attempt.id, "huber", text, kNow));
  ASSERT_TRUE(add_note(*repository_, other.attempt.id, "huber", "of Ben", kNow));
  EXPECT_EQ(count_notes(*repository_, anna.id).value(), (std::map<std::int64_t, std::int64_t>{{sequence, 2}}));
  const std::string csv = notes_csv(*repository_, {{}, {}, "spring"}).value();
  const auto row = [&](const char* text) {
    return config::csv_row({first.attempt.id, config::csv_text("=Anna"), config::csv_text("Spring"),
                            config::csv_text("liver-biopsy"), "2026-05-28T20:26:40Z", "2026-05-28T20:26:40Z",
                            config::csv_text("huber"), config::csv_text(text)});
  };
  EXPECT_EQ(csv, "attempt,person,course,task,started_utc,written_utc,author,note\r\n" + row("one") + row("two"));
  ASSERT_TRUE(delete_person(*repository_, anna.id));
  EXPECT_TRUE(list_notes(*repository_, first.attempt.id)->empty());
  EXPECT_EQ(list_notes(*repository_, other.attempt.id)->size(), 1U);
}

TEST_P(Notes, ListReasonsOfFailedAttempts) {
  const Person anna = add("Anna"), ben = add("Ben");
  const std::int64_t passed = put(attempt(anna.id, 90.0)), failed = put(attempt(anna.id, 40.0));
  put(attempt(ben.id, 40.0));
  AttemptRecord without = attempt(anna.id, 0.0);
  without.attempt.score.reset();
  without.fails.clear();
  without.not_scored = "the gun was not fired";
  const std::int64_t last = put(without);
  const auto all = list_reasons(*repository_, anna.id, passed, last);
  ASSERT_TRUE(all) << all.error().text();
  ASSERT_EQ(all->size(), 2U);
  EXPECT_EQ(all->at(failed).fails, std::vector<std::string>{"the lung was touched"});
  EXPECT_EQ(all->at(last).not_scored, "the gun was not fired");
  EXPECT_TRUE(all->at(last).fails.empty());
  EXPECT_EQ(list_reasons(*repository_, anna.id, failed, failed)->size(), 1U);
}

TEST_P(Notes, DamagedAttemptDoesNotHideOtherReasons) {
  const Person anna = add("Anna");
  const std::int64_t damaged = put(attempt(anna.id, 40.0)), whole = put(attempt(anna.id, 40.0));
  ASSERT_TRUE(repository_->database().transaction("cannot be damaged", [&](soci::session& session) {
    const long long sequence = damaged;
    session << "UPDATE attempt_details SET verdict = '{' WHERE sequence = :s", soci::use(sequence);
  }));
  const auto all = list_reasons(*repository_, anna.id, damaged, whole);
  ASSERT_TRUE(all) << all.error().text();
  EXPECT_EQ(all->at(whole).fails.front(), "the lung was touched");
  EXPECT_FALSE(all->at(damaged).fails.empty());
}

}  // namespace
}  // namespace trocar::results
