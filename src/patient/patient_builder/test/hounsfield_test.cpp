#include "anatomy/tissue/hounsfield.h"

#include <gtest/gtest.h>

#include <cmath>

#include "patient_builder/build_patient.h"
#include "patient_builder/test/make_torso.h"

namespace trocar::patient_builder {
namespace {

volume::CtGrid torso_ct() {
  return Torso().ct(Torso::grid({5, 5, 6}));
}

/// A CT whose numbers were changed by `change`.
volume::CtGrid changed_ct(auto change) {
  volume::CtGrid ct = torso_ct();
  for (std::int16_t& voxel : ct.voxels) voxel = static_cast<std::int16_t>(change(static_cast<int>(voxel)));
  return ct;
}

std::string finding(const volume::CtGrid& ct) {
  const Status status = anatomy::check_hounsfield(ct);
  return status ? "believed" : status.error().text();
}

TEST(Hounsfield, AcceptsACt) {
  EXPECT_EQ(finding(torso_ct()), "believed");
  // Padding outside of the field of view, and contrast agent in much of the body.
  EXPECT_EQ(finding(changed_ct([](int hu) { return hu == Torso::kAir ? -3024 : hu; })), "believed");
  EXPECT_EQ(finding(changed_ct([](int hu) { return hu == Torso::kMuscle ? 180 : hu; })), "believed");
}

TEST(Hounsfield, RejectsACtWithoutItsRescaleTags) {
  const std::string text = finding(changed_ct([](int hu) { return hu + 1024; }));
  EXPECT_NE(text.find("no air"), std::string::npos) << text;
  EXPECT_NE(text.find("24 to 1174"), std::string::npos) << text;
  EXPECT_NE(text.find("--rescale"), std::string::npos);
  // With padding that is negative.
  EXPECT_NE(finding(changed_ct([](int hu) { return hu == Torso::kAir ? -2000 : hu + 1024; })), "believed");
}

TEST(Hounsfield, RejectsAnInterceptAppliedTwice) {
  EXPECT_NE(finding(changed_ct([](int hu) { return hu - 1024; })), "believed");
}

TEST(Hounsfield, RejectsAnEightBitWindow) {
  EXPECT_NE(finding(changed_ct([](int hu) { return std::clamp((hu + 160) * 255 / 400, 0, 255); })), "believed");
  EXPECT_NE(finding(changed_ct([](int hu) { return std::clamp(hu, -160, 240); })), "believed");
}

TEST(Hounsfield, RejectsConstantAndNoiseImages) {
  EXPECT_NE(finding(changed_ct([](int) { return 0; })), "believed");
  EXPECT_NE(
      finding(changed_ct([n = 0U](int) mutable { return static_cast<int>((n = n * 1664525U + 1013904223U) >> 20); })),
      "believed");
}

TEST(Hounsfield, RescaleConvertsStoredNumbersToHu) {
  volume::CtGrid ct = changed_ct([](int hu) { return 2 * (hu + 1024); });
  ASSERT_TRUE(anatomy::apply_rescale({0.5, -1024.0}, ct));
  EXPECT_EQ(ct.voxels, torso_ct().voxels);
}

TEST(Hounsfield, RefusesAnImpossibleRescale) {
  for (const anatomy::Rescale& rescale : {anatomy::Rescale{0.0, 0.0}, anatomy::Rescale{std::nan(""), 0.0},
                                          anatomy::Rescale{1.0, INFINITY}, anatomy::Rescale{1e9, 0.0}}) {
    volume::CtGrid ct = torso_ct();
    const Status status = anatomy::apply_rescale(rescale, ct);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().exit_status, 2);
  }
  volume::CtGrid ct = torso_ct();
  EXPECT_FALSE(anatomy::apply_rescale({1000.0, 0.0}, ct));
}

TEST(Hounsfield, BuildsNoPatientFromNonHuNumbers) {
  std::vector<std::string> warnings;
  const LabelSource liver{"liver.nii.gz", Torso::mask(Torso::grid({5, 5, 6}), Torso::is_liver), {{1, "liver"}}};
  ASSERT_TRUE(build_patient(torso_ct(), {liver}, {"test", {}}, warnings));
  const auto built = build_patient(changed_ct([](int hu) { return hu + 1024; }), {liver}, {"test", {}}, warnings);
  ASSERT_FALSE(built);
  EXPECT_NE(built.error().text().find("no air"), std::string::npos);
}

}  // namespace
}  // namespace trocar::patient_builder
