#include "exams/exam_body.h"

#include <gtest/gtest.h>

#include <set>

namespace trocar::exams {
namespace {

SeenBody attempt_on(const std::string& patient, std::uint64_t seed, const std::string& person = {}) {
  return {"attempt", person, patient, seed, {}, {}};
}

const FitCheck kAlways = [](std::uint64_t number) -> Result<std::string> { return std::to_string(number); };

TEST(ExamBody, IsDrawnBySeedAndNeverThePractisedBody) {
  std::set<std::uint64_t> numbers;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto body = draw_body("biopsy-2", {}, seed, kAlways);
    ASSERT_TRUE(body);
    EXPECT_GE(body->number, 1000u);
    EXPECT_LE(body->number, 9999u);
    EXPECT_FALSE(body->is_known);
    EXPECT_EQ(body->number, draw_body("biopsy-2", {}, seed, kAlways)->number);
    numbers.insert(body->number);
  }
  EXPECT_GT(numbers.size(), 180u);  // 200 of 9000: about 2 coincidences are expected
}

TEST(ExamBody, IsNeverDrawnFromTheHistory) {
  const std::uint64_t first = draw_body("biopsy-2", {}, 5, kAlways)->number;
  std::vector<SeenBody> history{attempt_on("biopsy-2", first)};
  const std::uint64_t second = draw_body("biopsy-2", history, 5, kAlways)->number;
  EXPECT_NE(second, first);
  EXPECT_EQ(draw_body("biopsy-3", history, 5, kAlways)->number, first);  // another patient
  // All but one number are known.
  history.clear();
  for (std::uint64_t number = 1000; number <= 9999; ++number)
    if (number != 4711) history.push_back(attempt_on("biopsy-2", number));
  EXPECT_EQ(draw_body("biopsy-2", history, 5, kAlways)->number, 4711u);
  history.push_back(attempt_on("biopsy-2", 4711));
  const auto none = draw_body("biopsy-2", history, 5, kAlways);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().text().find("all bodies are known"), std::string::npos);
}

TEST(ExamBody, IsRecognisedByContentUnderAnotherName) {
  SeenBody elsewhere = attempt_on("/cases/copy", 1);
  elsewhere.hash = "4711";  // kAlways takes the number for the content
  EXPECT_TRUE(find_body({"biopsy-2", 4711}, {&elsewhere, 1}, {}, kAlways)->is_known);
  EXPECT_FALSE(find_body({"biopsy-2", 4712}, {&elsewhere, 1}, {}, kAlways)->is_known);
  std::vector<SeenBody> all;
  const std::uint64_t first = draw_body("biopsy-2", {}, 5, kAlways)->number;
  elsewhere.hash = std::to_string(first);
  all.push_back(elsewhere);
  EXPECT_NE(draw_body("biopsy-2", all, 5, kAlways)->number, first);
}

TEST(ExamBody, ReplacesAnUnfitBody) {
  const std::uint64_t first = draw_body("biopsy-2", {}, 5, kAlways)->number;
  const auto body = draw_body("biopsy-2", {}, 5, [&](std::uint64_t number) -> Result<std::string> {
    if (number == first) return fail("there is no safe path");
    return {};
  });
  ASSERT_TRUE(body);
  EXPECT_NE(body->number, first);
  EXPECT_EQ(body->unfit, std::vector<std::uint64_t>{first});
}

TEST(ExamBody, FailsWithAReasonIfNoBodyIsFit) {
  int tries = 0;
  const auto body = draw_body("biopsy-2", {}, 5, [&](std::uint64_t) -> Result<std::string> {
    ++tries;
    return fail("there is no safe path");
  });
  ASSERT_FALSE(body);
  EXPECT_EQ(tries, kMostTries);
  EXPECT_NE(body.error().text().find("no safe path"), std::string::npos);
}

TEST(ExamBody, ReportsIfAGivenNumberIsKnown) {
  const std::vector<SeenBody> history{attempt_on("biopsy-2", 4711)};
  EXPECT_TRUE(find_body({"biopsy-2", 4711}, history, {}, kAlways)->is_known);
  EXPECT_FALSE(find_body({"biopsy-2", 4712}, history, {}, kAlways)->is_known);
  EXPECT_FALSE(find_body({"biopsy-3", 4711}, history, {}, kAlways)->is_known);
  const std::vector<SeenBody> of_ada{attempt_on("biopsy-2", 4711, "ada")};
  EXPECT_TRUE(find_body({"biopsy-2", 4711}, of_ada, "ada", kAlways)->is_known);
  EXPECT_FALSE(find_body({"biopsy-2", 4711}, of_ada, "bob", kAlways)->is_known);
  EXPECT_TRUE(find_body({"biopsy-2", 4711}, of_ada, {}, kAlways)->is_known) << "nobody named: of anybody";
  for (const std::uint64_t number : {std::uint64_t{0}, std::uint64_t{1}, kMostNumber + 1}) {
    const auto body = find_body({"biopsy-2", number}, history, {}, kAlways);
    ASSERT_FALSE(body) << number;
    EXPECT_EQ(body.error().exit_status, 2);
  }
  const auto unfit =
      find_body({"biopsy-2", 4711}, history, {}, [](std::uint64_t) -> Result<std::string> { return fail("no liver"); });
  ASSERT_FALSE(unfit);
  EXPECT_NE(unfit.error().text().find("exam 4711 cannot be held: no liver"), std::string::npos);
}

TEST(ExamBody, RecognisesAFolderForAnySeed) {
  const std::vector<SeenBody> history{attempt_on("/cases/one", 1)};
  EXPECT_TRUE(is_known_body(history, {"/cases/one", 9}));
  EXPECT_FALSE(is_known_body(history, {"/cases/two", 1}));
}

TEST(ExamBody, EachTaskHasAPatientOfEachDifficulty) {
  EXPECT_EQ(patient_of_difficulty("liver-biopsy", 2), "biopsy-2");
  EXPECT_EQ(patient_of_difficulty("ptcd", 5), "ptcd-5");
  EXPECT_FALSE(patient_of_difficulty("liver-biopsy", 6));
  EXPECT_FALSE(patient_of_difficulty("no-such-task", 1));
}

TEST(ExamBody, IsCheckedOnTheRealBody) {
  // A layered scene serves a biopsy and, without a spine, no lumbar puncture.
  EXPECT_TRUE(fit_check("liver-biopsy", "layers-liver", {})(7));
  const auto unfit = fit_check("lumbar-puncture", "layers-liver", {})(7);
  EXPECT_FALSE(unfit);
}

}  // namespace
}  // namespace trocar::exams
