// Numbers of other data sets are told from the CT; right ones are not doubted.
#include <algorithm>
#include <cmath>

#include "anatomy/testing/shipped_structures.h"
#include "patient_builder/plausibility/judge_anatomy.h"

namespace trocar::patient_builder {
namespace {

struct NumberedBall {
  std::string name;
  int number;  ///< TotalSegmentator 2.
  Vec3 middle_P;
  double radius_mm;
  std::int16_t hu;
};

/// An adult's places, sizes and HU.
std::vector<NumberedBall> adult() {
  return {{"liver", 5, {-65, -15, 60}, 68, 110},
          {"spleen", 1, {95, 30, 75}, 35, 120},
          {"stomach", 6, {50, -45, 60}, 30, 30},
          {"kidney_left", 3, {58, 45, -20}, 32, 160},
          {"kidney_right", 2, {-58, 45, -30}, 32, 160},
          {"gallbladder", 4, {-45, -70, -20}, 16, 8},
          {"pancreas", 7, {10, -25, 15}, 22, 90},
          {"aorta", 52, {10, 20, 0}, 14, 180},
          {"inferior_vena_cava", 63, {-15, 22, 0}, 14, 140},
          {"urinary_bladder", 21, {0, -40, -150}, 30, 5},
          {"vertebrae_L1", 31, {0, 60, 30}, 18, 220},
          {"vertebrae_L2", 30, {0, 60, -6}, 18, 225},
          {"vertebrae_L3", 29, {0, 60, -42}, 18, 230},
          {"vertebrae_L4", 28, {0, 60, -78}, 18, 228}};
}

volume::GridGeometry adult_grid() {
  volume::GridGeometry g;
  g.size = {62, 46, 72};
  g.spacing_mm = {5, 5, 5};
  g.origin_P = {-152, -112, -190};
  return g;
}

const NumberedBall* ball_at(const std::vector<NumberedBall>& balls, const Vec3& p_P) {
  const NumberedBall* found = nullptr;
  for (const NumberedBall& ball : balls)
    if ((p_P - ball.middle_P).norm() < ball.radius_mm) found = &ball;
  return found;
}

volume::CtGrid ct_of(const std::vector<NumberedBall>& balls) {
  volume::CtGrid ct(adult_grid(), -1000);
  for (std::size_t n = 0; n < ct.voxels.size(); ++n) {
    const Vec3 p_P = ct.geometry.centre_mm(ct.geometry.index_of(n));
    const NumberedBall* ball = ball_at(balls, p_P);
    if (std::hypot(p_P.x() / 140.0, p_P.y() / 100.0) < 1.0)
      ct.voxels[n] = ball != nullptr ? ball->hu : std::int16_t{-90};
  }
  return ct;
}

using Meaning = std::vector<std::pair<int, std::string>>;

/// The balls with the numbers that `drawn` gives them, read as `read`.
LabelSource numbered(const std::vector<NumberedBall>& balls, const Meaning& drawn, const Meaning& read) {
  LabelSource source{"seg.nii.gz", volume::LabelGrid(adult_grid()), {}, false};
  for (std::size_t n = 0; n < source.labels.voxels.size(); ++n) {
    const NumberedBall* ball = ball_at(balls, source.labels.geometry.centre_mm(source.labels.geometry.index_of(n)));
    if (ball == nullptr) continue;
    const auto number = std::ranges::find(drawn, ball->name, &std::pair<int, std::string>::second);
    if (number != drawn.end()) source.labels.voxels[n] = static_cast<std::uint8_t>(number->first);
  }
  source.names = read;
  source.numbers_of = "TotalSegmentator 2";
  return source;
}

const Meaning kVersion2Low{{1, "spleen"},
                           {2, "kidney_right"},
                           {3, "kidney_left"},
                           {4, "gallbladder"},
                           {5, "liver"},
                           {6, "stomach"},
                           {7, "pancreas"},
                           {8, "adrenal_gland_right"},
                           {9, "adrenal_gland_left"},
                           {10, "lung_upper_lobe_left"},
                           {11, "lung_lower_lobe_left"}};
const Meaning kBtcv{{1, "spleen"},  {2, "kidney_right"}, {3, "kidney_left"},        {4, "gallbladder"}, {6, "liver"},
                    {7, "stomach"}, {8, "aorta"},        {9, "inferior_vena_cava"}, {11, "pancreas"}};
const Meaning kChaos{{1, "liver"}, {2, "kidney_right"}, {3, "kidney_left"}, {4, "spleen"}};
const Meaning kWord{{1, "liver"}, {2, "spleen"}, {3, "kidney_left"}, {4, "kidney_right"}};

std::vector<AnatomyFinding> found_in(const std::vector<NumberedBall>& balls, const LabelSource& source) {
  return judge_numbers(ct_of(balls), {source}, testing::shipped_structures());
}

/// The numbers of one data set, read as TotalSegmentator 2, with these as other readings.
std::vector<AnatomyFinding> found_of(const Meaning& drawn, const std::vector<OtherReading>& others) {
  Meaning read;
  for (const auto& [number, name] : drawn)
    if (const auto named = std::ranges::find(kVersion2Low, number, &std::pair<int, std::string>::first);
        named != kVersion2Low.end())
      read.push_back(*named);
  LabelSource source = numbered(adult(), drawn, read);
  source.other_readings = others;
  return found_in(adult(), source);
}

TEST(JudgeNumbers, RefusesNumbersOfAnotherDataSetByName) {
  for (const auto& [name, meaning] : {std::pair("btcv", kBtcv), std::pair("chaos", kChaos), std::pair("word", kWord)}) {
    std::vector<OtherReading> others;
    if (meaning.size() == 4)
      others = {{"chaos", "CHAOS", kChaos}, {"word", "WORD", kWord}};
    else
      others = {{"btcv", "BTCV", kBtcv}};
    const auto findings = found_of(meaning, others);
    ASSERT_EQ(findings.size(), 1U) << name;
    EXPECT_TRUE(findings.front().is_grave);
    EXPECT_EQ(findings.front().repair, std::string(kUseLabelMap) + name) << findings.front().text;
  }
}

TEST(JudgeNumbers, NamesSeveralMatchingDataSetsWithoutARepair) {
  // A liver alone is as well the liver of two data sets.
  const std::vector<NumberedBall> balls = adult();
  const Meaning one{{1, "liver"}, {2, "gallbladder"}};
  LabelSource source = numbered(balls, one, {{1, "spleen"}, {2, "kidney_right"}});
  source.other_readings = {{"a", "A", one}, {"b", "B", {{1, "liver"}, {2, "liver_tumor"}}}};
  const auto findings = found_in(balls, source);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_NE(findings.front().text.find("A or B"), std::string::npos) << findings.front().text;
  EXPECT_TRUE(findings.front().repair.empty());
}

TEST(JudgeNumbers, ALiverReadAsASpleenIsRefused) {
  LabelSource source = numbered(adult(), {{1, "liver"}}, {{1, "spleen"}});
  source.other_readings = {{"lits", "LiTS", {{1, "liver"}}}, {"verse", "VerSe", {{1, "vertebrae_C1"}}}};
  const auto findings = found_in(adult(), source);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_NE(findings.front().advice.find("--label-map lits"), std::string::npos) << findings.front().advice;
  // A mirrored spleen lies there, too: no repair is offered.
  EXPECT_NE(findings.front().advice.find("mirrored"), std::string::npos) << findings.front().advice;
  EXPECT_TRUE(findings.front().repair.empty());
}

TEST(JudgeNumbers, VertebraeReadAsBowelAndBladderAreRefused) {
  const std::vector<NumberedBall> balls = adult();
  const Meaning verse{{20, "vertebrae_L1"}, {21, "vertebrae_L2"}, {22, "vertebrae_L3"}, {23, "vertebrae_L4"}};
  LabelSource source =
      numbered(balls, verse, {{20, "colon"}, {21, "urinary_bladder"}, {22, "prostate"}, {23, "kidney_cyst_left"}});
  source.other_readings = {{"verse", "VerSe", verse}};
  const auto findings = found_in(balls, source);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings.front().repair, "--label-map verse");
}

TEST(JudgeNumbers, RefusesUnknownNumbersWithoutARepair) {
  // Every structure has the name of another one.
  const std::vector<NumberedBall> balls = adult();
  Meaning drawn, read;
  for (const NumberedBall& ball : balls) drawn.emplace_back(ball.number, ball.name);
  for (std::size_t n = 0; n < balls.size(); ++n) read.emplace_back(balls[n].number, balls[(n + 5) % balls.size()].name);
  const auto findings = found_in(balls, numbered(balls, drawn, read));
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_TRUE(findings.front().is_grave);
  EXPECT_TRUE(findings.front().repair.empty());
  EXPECT_NE(findings.front().text.find("no other known numbers"), std::string::npos);
  // Names that a user has written are not judged as numbers.
  LabelSource own = numbered(balls, drawn, read);
  own.numbers_of.clear();
  EXPECT_TRUE(found_in(balls, own).empty());
}

TEST(JudgeNumbers, AcceptsCorrectNumbers) {
  Meaning all;
  for (const NumberedBall& ball : adult()) all.emplace_back(ball.number, ball.name);
  const std::vector<OtherReading> others{{"btcv", "BTCV", kBtcv}, {"chaos", "CHAOS", kChaos}, {"word", "WORD", kWord}};
  const auto expect_nothing = [&](const std::vector<NumberedBall>& balls, const Meaning& drawn, const char* what) {
    LabelSource source = numbered(balls, drawn, drawn);
    for (OtherReading other : others) {
      std::erase_if(other.names, [&](const auto& n) {
        return std::ranges::find(drawn, n.first, &std::pair<int, std::string>::first) == drawn.end();
      });
      if (other.names.size() == drawn.size() && other.names != drawn) source.other_readings.push_back(std::move(other));
    }
    const auto findings = found_in(balls, source);
    EXPECT_TRUE(findings.empty()) << what << ": " << findings.front().text;
  };
  expect_nothing(adult(), all, "whole");
  // Parts, as by --roi_subset.
  for (const NumberedBall& a : adult())
    for (const NumberedBall& b : adult())
      if (a.number < b.number) expect_nothing(adult(), {{a.number, a.name}, {b.number, b.name}}, a.name.c_str());
  expect_nothing(adult(), {{1, "spleen"}, {2, "kidney_right"}, {3, "kidney_left"}, {4, "gallbladder"}}, "four organs");
  // Late after contrast agent: bright kidneys, vessels and bladder.
  std::vector<NumberedBall> urography = adult();
  for (NumberedBall& ball : urography) {
    if (ball.name.starts_with("kidney")) ball.hu = 320;
    if (ball.name == "urinary_bladder") ball.hu = 700;
    if (ball.name == "aorta") ball.hu = 420;
  }
  expect_nothing(urography, all, "urography");
  expect_nothing(urography, {{2, "kidney_right"}, {3, "kidney_left"}, {21, "urinary_bladder"}}, "urinary tract");
  // A child of half the size.
  std::vector<NumberedBall> child = adult();
  for (NumberedBall& ball : child) ball.middle_P *= 0.6, ball.radius_mm *= 0.6;
  expect_nothing(child, all, "child");
  // A transplanted kidney, exchanged kidneys and situs inversus are judged elsewhere.
  std::vector<NumberedBall> transplant = adult();
  transplant[3].middle_P = {60, -20, -140};
  expect_nothing(transplant, all, "transplant");
  Meaning exchanged = all;
  std::swap(exchanged[3].first, exchanged[4].first);
  LabelSource kidneys = numbered(adult(), exchanged, all);
  EXPECT_TRUE(found_in(adult(), kidneys).empty());
  std::vector<NumberedBall> mirrored = adult();
  for (NumberedBall& ball : mirrored) ball.middle_P.x() *= -1.0;
  expect_nothing(mirrored, all, "situs inversus");
}

}  // namespace
}  // namespace trocar::patient_builder
