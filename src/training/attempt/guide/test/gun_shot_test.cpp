#include <gtest/gtest.h>

#include <memory>

#include "attempt/guide/needle_view.h"
#include "attempt/guide/puncture_guide.h"
#include "cases/testing/cached_case.h"

namespace trocar::attempt {
namespace {

const cases::OpenCase& liver() {
  static const std::shared_ptr<const cases::OpenCase> open = [] {
    cases::CaseChoice choice;
    choice.patient_source = "layers-liver";
    return *testing::open_cached_case(choice);
  }();
  return *open;
}

telemetry::TickSample at_target() {
  const Segment& plan_P = liver().the_case.plan.line_P;
  telemetry::TickSample sample;
  sample.time_s = 12.0;
  sample.tip_mm = plan_P.b;
  sample.axis = plan_P.direction();
  telemetry::set_at_rest(sample);
  sample.depth_mm = plan_P.length_mm();
  sample.phase = telemetry::InsertionPhase::kInserted;
  return sample;
}

TEST(GunShot, TakesACoreAtTheNotch) {
  const cases::Case& the_case = liver().the_case;
  const GunShot shot = make_gun_shot(the_case, at_target());
  EXPECT_EQ(shot.throw_mm, the_case.needle.throw_mm);
  EXPECT_NEAR((shot.core_P.b - at_target().tip_mm).norm(), shot.throw_mm - the_case.needle.dead_space_mm, 1e-9);
  EXPECT_NEAR(shot.core_P.length_mm(), the_case.needle.notch_mm, 1e-9);
  ASSERT_FALSE(shot.pieces.empty());
  double target_mm = 0.0;
  for (const ShotPiece& piece : shot.pieces)
    if (piece.part == scoring::CorePart::kTarget) target_mm += piece.to_mm - piece.from_mm;
  EXPECT_NEAR(target_mm, shot.core.target_mm, 1e-9);
  EXPECT_GT(target_mm, 5.0);
  EXPECT_NE(shot_words(shot).find("target tissue"), std::string::npos) << shot_words(shot);
}

TEST(GunShot, TakesNothingOutsideTheBody) {
  telemetry::TickSample outside = at_target();
  outside.depth_mm = 0.0;
  const GunShot shot = make_gun_shot(liver().the_case, outside);
  EXPECT_TRUE(shot.pieces.empty());
  EXPECT_NE(shot_words(shot).find("outside the body"), std::string::npos);
}

TEST(GunShot, ThrowsTheStyletThenTheCannula) {
  const GunShot shot = make_gun_shot(liver().the_case, at_target());
  EXPECT_EQ(throw_at(shot, 0.0, shot.depth_mm).stylet_mm, 0.0);
  const GunThrow half = throw_at(shot, 0.5 * kStyletMoves_s, shot.depth_mm);
  EXPECT_NEAR(half.stylet_mm, 0.5 * shot.throw_mm, 1e-9);
  EXPECT_EQ(half.cannula_mm, 0.0);
  const GunThrow open = throw_at(shot, kStyletMoves_s, shot.depth_mm);
  EXPECT_EQ(open.stylet_mm, shot.throw_mm);
  EXPECT_EQ(open.cannula_mm, 0.0);
  const GunThrow end = throw_at(shot, 60.0, shot.depth_mm);
  EXPECT_EQ(end.stylet_mm, shot.throw_mm);
  EXPECT_EQ(end.cannula_mm, shot.throw_mm);
}

TEST(GunShot, WithdrawalRetractsTheThrow) {
  GunShot shot = make_gun_shot(liver().the_case, at_target());
  EXPECT_NEAR(throw_at(shot, 60.0, 0.5 * shot.depth_mm).cannula_mm, 0.5 * shot.throw_mm, 1e-9);
  EXPECT_EQ(throw_at(shot, 60.0, 0.0).cannula_mm, 0.0);
  EXPECT_EQ(throw_at(shot, 60.0, 0.0).stylet_mm, 0.0);
  shot.depth_mm = 0.0;  // fired outside
  EXPECT_EQ(throw_at(shot, 60.0, 0.0).stylet_mm, 0.0);
}

TEST(GunShot, ThrownShaftIsExtendedAlongItsEnd) {
  const std::vector<Vec3> shaft_P{Vec3(0, 0, 0), Vec3(0, 0, 10), Vec3(3, 0, 14)};
  const std::vector<Vec3> thrown_P = thrown_shaft(shaft_P, 5.0);
  ASSERT_EQ(thrown_P.size(), 4u);
  EXPECT_NEAR((thrown_P.back() - Vec3(6, 0, 18)).norm(), 0.0, 1e-9);
  EXPECT_EQ(thrown_shaft(shaft_P, 0.0).size(), 3u);
  EXPECT_TRUE(thrown_shaft({}, 5.0).empty());
}

TEST(GunShot, HintAdvancesToTheNextCoreAndToWithdrawal) {
  telemetry::TickSample sample = at_target();
  EXPECT_NE(guide_puncture(liver().the_case, sample).find("fire"), std::string::npos);
  const cases::Case& the_case = liver().the_case;
  ASSERT_EQ(the_case.task.cores, 2u);
  EXPECT_NE(guide_puncture(the_case, sample, {1, false}).find("load the gun"), std::string::npos);
  EXPECT_NE(guide_puncture(the_case, sample, {1, true}).find("fire"), std::string::npos);
  EXPECT_NE(guide_puncture(the_case, sample, {2, false}).find("withdraw the needle"), std::string::npos);
  cases::Case plain = the_case;
  plain.needle.is_coaxial = false;
  EXPECT_NE(guide_puncture(plain, sample, {1, false}).find("withdraw the needle, then load"), std::string::npos);
  sample.depth_mm = 0.0;
  sample.phase = telemetry::InsertionPhase::kOutside;
  EXPECT_NE(guide_puncture(plain, sample, {1, false}).find("load the gun"), std::string::npos);
  EXPECT_NE(guide_puncture(the_case, sample, {2, false}).find("end the attempt"), std::string::npos);
}

}  // namespace
}  // namespace trocar::attempt
