#include "results/attempts.h"

#include <thread>

#include "results_lab.h"

namespace trocar::results {
namespace {

class Attempts : public ResultsTest {};
TROCAR_BOTH_DATABASES(Attempts);

TEST_P(Attempts, RoundTrip) {
  const Person anna = add("Anna");
  AttemptRecord written = attempt(anna.id, 72.25);
  std::string recording;
  for (int n = 0; n < 70'000; ++n) recording += static_cast<char>(n % 256);
  written.attempt.sequence = put(written, recording);
  const auto loaded = load_attempt(*repository_, written.attempt.id);
  ASSERT_TRUE(loaded) << loaded.error().text();
  ASSERT_TRUE(*loaded);
  const AttemptRecord& read = **loaded;
  EXPECT_EQ(read.attempt.sequence, written.attempt.sequence);
  EXPECT_EQ(read.attempt.person_id, anna.id);
  EXPECT_EQ(read.attempt.the_case.patient_hash, "abc");
  EXPECT_EQ(read.attempt.the_case.difficulty, 1);
  EXPECT_EQ(read.attempt.started, kNow);
  EXPECT_EQ(read.attempt.state, State::kFinished);
  EXPECT_EQ(read.attempt.score, 72.25);
  EXPECT_TRUE(read.attempt.is_passed);
  EXPECT_EQ(read.attempt.duration_s, 31.5);
  ASSERT_EQ(read.hints.size(), 2u);
  EXPECT_EQ(read.hints[0].text, "Breathe \"out\"");
  EXPECT_EQ(read.hints[0].at_s, 3.25);
  EXPECT_FALSE(read.hints[1].at_s);
  ASSERT_EQ(read.parts.size(), 2u);
  EXPECT_EQ(read.parts[0].points, 0.3 * 72.25);
  ASSERT_EQ(read.measures.size(), 2u);
  EXPECT_EQ(read.measures[0].unit, "mm");
  ASSERT_EQ(read.trace.time_s.size(), 2u);
  EXPECT_NEAR(read.trace.force_n[1], -1.234, 1e-12);
  EXPECT_NEAR(read.trace.tip_mm[2][1], -3.25, 1e-12);
  EXPECT_EQ(read.trace.tissues[1], "skin");
  EXPECT_EQ(read.trace.plan_target_mm[2], 30.0);
  EXPECT_EQ(read.trace.events[0].text, "puncture:skin");
  const auto bytes = load_recording(*repository_, written.attempt.id);
  ASSERT_TRUE(bytes && *bytes);
  EXPECT_EQ(**bytes, recording);
}

TEST_P(Attempts, AreRefusedWithoutAPerson) {
  const auto refused = record_attempt(*repository_, attempt("nobody", 50.0), {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what, "no such person");
  EXPECT_TRUE(list_attempts(*repository_, {})->empty());
}

TEST_P(Attempts, AreCompletedOnlyOnce) {
  const Person anna = add("Anna");
  AttemptRecord record = attempt(anna.id, 72.0);
  Attempt begun = record.attempt;
  begun.state = State::kRunning;
  ASSERT_TRUE(begin_attempt(*repository_, begun));
  ASSERT_TRUE(begin_attempt(*repository_, begun));
  auto all = list_attempts(*repository_, {});
  ASSERT_EQ(all->size(), 1u);
  EXPECT_EQ(all->front().state, State::kRunning);
  EXPECT_FALSE(all->front().score);
  // First what a killed program left, then the whole session.
  AttemptRecord cut = record;
  cut.attempt.state = State::kInterrupted;
  cut.attempt.score.reset();
  cut.measures.clear();
  const std::int64_t sequence = put(cut);
  EXPECT_EQ(put(record), sequence);
  record.attempt.score = 1.0;
  EXPECT_EQ(put(record), sequence);  // finished: stays
  all = list_attempts(*repository_, {});
  ASSERT_EQ(all->size(), 1u);
  EXPECT_EQ(all->front().score, 72.0);
  EXPECT_EQ(load_attempt(*repository_, record.attempt.id)->value().measures.size(), 2u);
}

TEST_P(Attempts, AreForgottenOnlyIfUnfinished) {
  const Person anna = add("Anna");
  AttemptRecord record = attempt(anna.id, 72.0), begun = attempt(anna.id, 0.0);
  put(record);
  ASSERT_TRUE(begin_attempt(*repository_, begun.attempt));
  ASSERT_TRUE(forget_begun_attempt(*repository_, begun.attempt.id));
  ASSERT_TRUE(forget_begun_attempt(*repository_, record.attempt.id));
  EXPECT_EQ(list_attempts(*repository_, {})->size(), 1u);
}

TEST_P(Attempts, AreListedByFilterAndPage) {
  const Person anna = add("Anna", Group::kTrainee, "A"), ben = add("Ben");
  for (int n = 0; n < 7; ++n) put(attempt(anna.id, n));
  put(attempt(anna.id, 50.0, "ptcd"));
  put(attempt(ben.id, 60.0));
  EXPECT_EQ(list_attempts(*repository_, {anna.id})->size(), 8u);
  EXPECT_EQ(list_attempts(*repository_, {anna.id, "ptcd"})->size(), 1u);
  EXPECT_EQ(list_attempts(*repository_, {{}, {}, "a"})->size(), 8u);
  EXPECT_EQ(list_attempts(*repository_, {{}, {}, "none"})->size(), 0u);
  AttemptFilter page{anna.id, "liver-biopsy"};
  page.is_newest_first = true;
  page.limit = 3;
  std::vector<double> scores;
  for (;;) {
    const auto attempts = list_attempts(*repository_, page);
    ASSERT_TRUE(attempts);
    if (attempts->empty()) break;
    for (const Attempt& one : *attempts) scores.push_back(*one.score);
    page.before = attempts->back().sequence;
  }
  EXPECT_EQ(scores, (std::vector<double>{6, 5, 4, 3, 2, 1, 0}));
}

TEST_P(Attempts, KeepTheirOrderWhenTheClockIsSetBack) {
  const Person anna = add("Anna");
  for (const int days : {0, 2, -40, 1}) {
    AttemptRecord record = attempt(anna.id, 50.0 + days);
    record.attempt.started += std::chrono::days(days);
    put(record);
  }
  std::vector<double> scores;
  const auto past = past_attempts(*repository_, anna.id);
  ASSERT_TRUE(past);
  for (const learning::PastAttempt& one : *past) scores.push_back(*one.score);
  EXPECT_EQ(scores, (std::vector<double>{50, 52, 10, 51}));
  EXPECT_EQ(*summarise_tasks(*repository_)->front().last_score, 51.0);
}

TEST_P(Attempts, AreSummarisedByPersonAndTask) {
  const Person anna = add("Anna"), ben = add("Ben");
  for (const double score : {10.0, 20.0, 30.0, 40.0, 90.0, 60.0, 70.0}) put(attempt(anna.id, score));
  AttemptRecord unscored = attempt(anna.id, 0.0);
  unscored.attempt.score.reset();
  unscored.attempt.is_passed = true;  // of a program that is wrong
  put(unscored);
  unscored.attempt.id = make_id();
  unscored.measures.push_back({"skin_punctures", "1", 0.0});
  put(unscored);
  unscored.attempt.id = make_id();
  unscored.attempt.state = State::kInterrupted;
  put(unscored);
  unscored.attempt.id = make_id();
  ASSERT_TRUE(begin_attempt(*repository_, unscored.attempt));
  put(attempt(ben.id, 5.0, "ptcd"));
  const auto summaries = summarise_tasks(*repository_);
  ASSERT_TRUE(summaries) << summaries.error().text();
  ASSERT_EQ(summaries->size(), 2u);
  const TaskSummary& of_anna = (*summaries)[(*summaries)[0].person_id == anna.id ? 0 : 1];
  EXPECT_EQ(of_anna.task, "liver-biopsy");
  EXPECT_EQ(of_anna.counts.counted(), 8);
  EXPECT_EQ(of_anna.counts.scored, 7);
  EXPECT_EQ(of_anna.counts.passed, 3);
  EXPECT_EQ(learning::counts_text(of_anna.counts),
            "8 attempts counted (1 ended without a result), 3 left out: 1 never began, 1 was lost to a crash, 1 is not "
            "over");
  const auto counts = count_attempts(*repository_, {anna.id, "liver-biopsy"});
  ASSERT_TRUE(counts) << counts.error().text();
  EXPECT_EQ(learning::counts_text(*counts), learning::counts_text(of_anna.counts));
  EXPECT_EQ(counts->passed, 3);
  EXPECT_EQ(of_anna.last_score, 70.0);
  EXPECT_EQ(of_anna.best_score, 90.0);
  EXPECT_EQ(of_anna.recent_mean, (30.0 + 40.0 + 90.0 + 60.0 + 70.0) / 5.0);
}

TEST_P(Attempts, ListMetricValuesWithTheirGroup) {
  const Person anna = add("Anna", Group::kTrainee, "A"), eva = add("Eva", Group::kExpert);
  put(attempt(anna.id, 40.0));
  put(attempt(eva.id, 95.0));
  put(attempt(eva.id, 97.0, "ptcd"));
  const auto samples = metric_samples(*repository_, "liver-biopsy", "path_length");
  ASSERT_TRUE(samples);
  ASSERT_EQ(samples->size(), 2u);
  EXPECT_EQ((*samples)[0].value, 140.0);
  EXPECT_EQ((*samples)[1].group, Group::kExpert);
  EXPECT_EQ(metric_samples(*repository_, "liver-biopsy", "score", "A")->size(), 1u);
  EXPECT_TRUE(metric_samples(*repository_, "liver-biopsy", "'; --")->empty());
  EXPECT_EQ(list_metrics(*repository_, "liver-biopsy")->size(), 2u);
  EXPECT_TRUE(list_metrics(*repository_, "none")->empty());
}

TEST_P(Attempts, FindTheBestExpertOnTheSameCase) {
  const Person anna = add("Anna"), eva = add("Eva", Group::kExpert);
  const auto robot = add_person(*repository_, {"Robot", Group::kExpert, {}, true}, kNow);
  const AttemptRecord mine = attempt(anna.id, 40.0);
  put(mine);
  EXPECT_FALSE(*find_expert_attempt(*repository_, mine.attempt));
  const AttemptRecord simulated = attempt(robot->id, 100.0);
  put(simulated);
  EXPECT_EQ(**find_expert_attempt(*repository_, mine.attempt), simulated.attempt.id);
  const AttemptRecord good = attempt(eva.id, 90.0), better = attempt(eva.id, 95.0);
  put(good);
  put(better);
  AttemptRecord other = attempt(eva.id, 99.0);
  other.attempt.the_case.seed = 2;
  put(other);
  EXPECT_EQ(**find_expert_attempt(*repository_, mine.attempt), better.attempt.id);
}

TEST_P(Attempts, AreAllRecordedFromTwoStationsAtOnce) {
  const Person anna = add("Anna");
  constexpr int kEach = 25;
  std::vector<Status> done(2);
  {
    std::vector<std::jthread> stations;
    for (Status& one : done)
      stations.emplace_back([&] {
        Repository station = open();
        for (int n = 0; one && n < kEach; ++n) {
          const auto sequence = record_attempt(station, attempt(anna.id, n), "bytes");
          if (!sequence) one = tl::unexpected(sequence.error());
        }
      });
  }
  for (const Status& one : done) EXPECT_TRUE(one) << one.error().text();
  EXPECT_EQ(list_attempts(*repository_, {})->size(), 2u * kEach);
}

TEST_P(Attempts, AreRecordedOnceFromTwoStations) {
  const Person anna = add("Anna");
  const AttemptRecord record = attempt(anna.id, 50.0);
  {
    std::vector<std::jthread> stations;
    for (int n = 0; n < 4; ++n)
      stations.emplace_back([&] {
        Repository station = open();
        EXPECT_TRUE(record_attempt(station, record, "bytes"));
      });
  }
  EXPECT_EQ(list_attempts(*repository_, {})->size(), 1u);
}

TEST_P(Attempts, AreDeletedOneByOne) {
  const Person anna = add("Anna");
  const AttemptRecord record = attempt(anna.id, 50.0);
  put(record, "bytes");
  ASSERT_TRUE(delete_attempt(*repository_, record.attempt.id));
  EXPECT_FALSE(delete_attempt(*repository_, record.attempt.id));
  EXPECT_TRUE(list_attempts(*repository_, {})->empty());
  EXPECT_FALSE(load_recording(*repository_, record.attempt.id)->has_value());
}

TEST(AttemptsFile, PagesAndSummarisesTenThousandAttempts) {
  TemporaryFolder folder;
  auto repository = Repository::open({folder / "a.sqlite", {}});
  ASSERT_TRUE(repository);
  const auto anna = add_person(*repository, {"Anna"}, Seconds()), ben = add_person(*repository, {"Ben"}, Seconds());
  constexpr int kAttempts = 10'000;
  std::vector<AttemptRecord> records(kAttempts);
  for (int n = 0; n < kAttempts; ++n) {
    Attempt& attempt = records[static_cast<std::size_t>(n)].attempt;
    attempt.id = std::to_string(n);
    attempt.person_id = n % 2 == 0 ? anna->id : ben->id;
    attempt.the_case.task = "liver-biopsy";
    attempt.state = State::kFinished;
    attempt.score = n % 101;
  }
  ASSERT_TRUE(record_attempts(*repository, records));
  AttemptFilter page{anna->id};
  page.is_newest_first = true;
  page.limit = 100;
  page.before = 5001;
  const auto attempts = list_attempts(*repository, page);
  ASSERT_TRUE(attempts);
  ASSERT_EQ(attempts->size(), 100u);
  EXPECT_EQ(attempts->front().id, "4998");
  EXPECT_EQ(attempts->back().id, "4800");
  const auto summaries = summarise_tasks(*repository);
  ASSERT_EQ(summaries->size(), 2u);
  EXPECT_EQ((*summaries)[0].counts.counted(), kAttempts / 2);
  EXPECT_EQ((*summaries)[0].best_score, 100.0);
}

TEST(AttemptsFile, LosesNothingOnAFullDisk) {
  TemporaryFolder folder;
  auto repository = Repository::open({folder / "a.sqlite", {}});
  ASSERT_TRUE(repository);
  const auto person = add_person(*repository, {"Anna"}, Seconds());
  AttemptRecord record;
  record.attempt.id = make_id();
  record.attempt.person_id = person->id;
  record.attempt.the_case.task = "liver-biopsy";
  record.attempt.state = State::kFinished;
  ASSERT_TRUE(record_attempt(*repository, record, "bytes"));
  ASSERT_TRUE(repository->database().run("x", [](soci::session& session) {
    session << "PRAGMA max_page_count = 1";  // the file may not grow, as on a full disk
  }));
  AttemptRecord next = record;
  next.attempt.id = make_id();
  const auto full = record_attempt(*repository, next, std::string(1'000'000, 'x'));
  ASSERT_FALSE(full);
  EXPECT_NE(full.error().what.find("the disk is full"), std::string::npos);
  EXPECT_EQ(list_attempts(*repository, {})->size(), 1u);
  EXPECT_EQ(**load_recording(*repository, record.attempt.id), "bytes");
}

}  // namespace
}  // namespace trocar::results
