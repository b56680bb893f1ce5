#include <gtest/gtest.h>

#include <cmath>

#include "attempt/guide/puncture_guide.h"

namespace trocar::attempt {
namespace {

/// Beam to the back, lateral to the patient's left: elevation towards the head.
Pose from_the_front() {
  Mat3 R_PT;
  R_PT.col(0) = Vec3::UnitX();
  R_PT.col(1) = Vec3::UnitY();
  R_PT.col(2) = Vec3::UnitZ();
  return {R_PT, Vec3(10.0, -90.0, 40.0)};
}

metrics::ImagePlane fan() {
  metrics::ImagePlane plane;
  plane.depth_mm = 100.0;
  plane.radius_mm = 50.0;
  plane.field_of_view_rad = 1.1;
  return plane;
}

/// A rib across the middle of the image, 20 to 30 mm deep.
anatomy::VirtualPatient with_rib(bool has_rib) {
  anatomy::VirtualPatient patient;
  volume::GridGeometry geometry;
  geometry.size = {100, 150, 100};
  geometry.origin_P = {-40.0, -100.0, -10.0};
  patient.labels = volume::LabelGrid(geometry);
  patient.label_table.labels = {{1, "rib_right_9", "bone", {}}};
  for (std::size_t n = 0; n < patient.labels.voxels.size(); ++n) {
    const Vec3 p_T = from_the_front().inverse() * geometry.centre_mm(geometry.index_of(n));
    if (has_rib && std::abs(p_T.x()) < 8.0 && p_T.y() > 20.0 && p_T.y() < 30.0) patient.labels.voxels[n] = 1;
  }
  return patient;
}

std::string advice(const Vec3& target_T, double contact_n = 1.0, bool has_rib = false) {
  return guide_transducer(with_rib(has_rib), {}, from_the_front() * target_T, from_the_front(), contact_n, fan());
}

TEST(TransducerGuide, AdvisesSkinContactFirst) {
  EXPECT_NE(advice({0.0, 50.0, 0.0}, 0.0).find("touch the skin"), std::string::npos);
  EXPECT_NE(advice({0.0, 50.0, 0.0}, std::nan("")).find("touch the skin"), std::string::npos);
}

TEST(TransducerGuide, StatesTheSideOfAFarTarget) {
  EXPECT_EQ(advice({-80.0, 40.0, 0.0}), "The target is 80 mm to the patient's right: move the transducer there");
  EXPECT_EQ(advice({0.0, 40.0, 60.0}), "The target is 60 mm towards the head: move the transducer there");
}

TEST(TransducerGuide, StatesThePlaneOffsetFromTheTarget) {
  EXPECT_EQ(advice({5.0, 60.0, -8.0}), "The image passes 8 mm beside the target: move or tilt it towards the feet");
}

TEST(TransducerGuide, StatesWhichImageEdgeHidesTheTarget) {
  EXPECT_NE(advice({0.0, 130.0, 0.0}).find("increase the depth"), std::string::npos);
  metrics::ImagePlane narrow = fan();
  narrow.field_of_view_rad = 0.3;
  const std::string beside =
      guide_transducer(with_rib(false), {}, from_the_front() * Vec3(40.0, 60.0, 0.0), from_the_front(), 1.0, narrow);
  EXPECT_NE(beside.find("to the patient's left"), std::string::npos) << beside;
}

TEST(TransducerGuide, AdvisesHoldingStillAtTheTarget) {
  EXPECT_EQ(advice({5.0, 60.0, 1.0}), "The target is in the image: hold still");
}

TEST(TransducerGuide, ReportsARibThatHidesTheTarget) {
  EXPECT_EQ(advice({0.0, 60.0, 0.0}, 1.0, true), "The right rib 9 hides the target: look beside it");
  EXPECT_NE(advice({25.0, 60.0, 0.0}, 1.0, true).find("hold still"), std::string::npos) << "beside the rib";
  EXPECT_NE(advice({0.0, 15.0, 0.0}, 1.0, true).find("hold still"), std::string::npos) << "before the rib";
}

TEST(TransducerGuide, IsSilentForNonFinitePoses) {
  EXPECT_TRUE(advice({std::nan(""), 0.0, 0.0}).empty());
}

TEST(TransducerGuide, RecognisesTransducerSteps) {
  tasks::Phase phase;
  phase.done = {{tasks::ConditionKind::kTipOnSkin, 0.0, {}}};
  EXPECT_FALSE(is_step_of_transducer(phase));
  phase.done.push_back({tasks::ConditionKind::kTargetInImage, 4.0, {}});
  EXPECT_TRUE(is_step_of_transducer(phase));
}

}  // namespace
}  // namespace trocar::attempt
