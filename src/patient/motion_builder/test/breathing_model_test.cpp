// The breathing model of the embedded abdomen: against published motions, against what a map may do, and at its border.
#include "motion_builder/breathing_model.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "motion/patient_motion.h"
#include "phantom/phantom.h"
#include "volume/sampling.h"

namespace trocar::motion_builder {
namespace {

const anatomy::VirtualPatient& abdomen() {
  static const anatomy::VirtualPatient patient = [] {
    auto made = *phantom::generate_phantom("abdomen", 1, {{0, 0, 0}, 2.0});
    add_breathing_model(made);
    return made;
  }();
  return patient;
}

Vec3 moved_mm(const std::string& name) {
  for (const StructureMotion& row : structure_motions(abdomen(), *abdomen().motion))
    if (row.name == name) return row.by_driver_mm[0] + row.by_driver_mm[1];
  ADD_FAILURE() << name;
  return Vec3::Zero();
}

motion::PatientMotion at(double diaphragm, double chest) {
  motion::MotionState state;
  state.drivers = {diaphragm, chest};
  return {abdomen().motion.get(), state};
}

/// Calls take(label, point) for some voxels of the body.
template <class Take>
void for_body(const Take& take) {
  const anatomy::VirtualPatient& patient = abdomen();
  for (std::size_t n = 0; n < patient.labels.voxels.size(); n += 7)
    if (patient.skin_distance_mm.voxels[n] < 0.0F)
      take(patient.labels.voxels[n], patient.labels.geometry.centre_mm(patient.labels.geometry.index_of(n)));
}

TEST(BreathingModel, MovesOrgansAsPublished) {
  ASSERT_NE(abdomen().motion, nullptr);
  const double liver_mm = -moved_mm("liver").z();
  EXPECT_NEAR(liver_mm, motion::kDeepLiver_mm, 0.8) << "PMID 12885454; the chest moves it a little, too";
  for (const char* const kidney : {"kidney_left", "kidney_right"}) {
    const double kidney_mm = -moved_mm(kidney).z();
    EXPECT_NEAR(kidney_mm, 16.5, 1.5) << "deep, PMID 12885454: 16 to 17 mm";
    EXPECT_NEAR(kidney_mm * motion::kQuietLiver_mm / motion::kDeepLiver_mm, 7.45, 1.0)
        << "quiet, doi 10.1186/1748-717X-8-248";
  }
  for (const char* const rests : {"vertebrae_T9", "vertebrae_L1", "vertebrae_L4"})
    EXPECT_LT(moved_mm(rests).norm(), 0.3);
  EXPECT_GT(moved_mm("rib_right_7").z(), 4.0) << "ribs rise";
  EXPECT_LT(moved_mm("rib_right_7").x(), moved_mm("rib_left_7").x() - 3.0) << "and go apart: bucket handle";
  EXPECT_LT(moved_mm("sternum").y(), -2.0) << "the sternum goes forward: pump handle";
  const double lung_mm = -moved_mm("lung_lower_lobe_right").z();
  EXPECT_GT(lung_mm, 8.0);
  EXPECT_LT(lung_mm, liver_mm);
}

/// Also at the ends of the drivers' range, and between them.
TEST(BreathingModel, NeverFoldsTissue) {
  for (const auto& [diaphragm, chest] :
       {std::pair(1.5, 1.5), std::pair(1.5, -0.3), std::pair(-0.3, 1.5), std::pair(0.7, 0.7)}) {
    const motion::PatientMotion now = at(diaphragm, chest);
    double least = 1e9;
    for_body([&](std::uint8_t, const Vec3& p_A) { least = std::min(least, now.jacobian(p_A).determinant()); });
    EXPECT_GT(least, 0.05) << diaphragm << ", " << chest;
  }
}

TEST(BreathingModel, KeepsTheVolumeOfOrgans) {
  const motion::PatientMotion deep = at(1.0, 1.0);
  double sum = 0.0, count = 0.0;
  const std::uint8_t liver = abdomen().label_table.find("liver")->id;
  for_body([&](std::uint8_t label, const Vec3& p_A) {
    if (label != liver) return;
    sum += deep.jacobian(p_A).determinant();
    count += 1.0;
  });
  EXPECT_NEAR(sum / count, 1.0, 0.02);
}

/// To 0.05 mm wherever the tissue is not within a gap or an overlap of both regions.
TEST(BreathingModel, InverseFindsTheTissue) {
  const motion::PatientMotion deep = at(1.0, 1.0);
  std::size_t points = 0, lost = 0;
  for_body([&](std::uint8_t, const Vec3& p_A) {
    const Vec3 p_P = deep.to_now(p_A);
    const double miss_mm = (deep.to_now(deep.to_rest(p_P)) - p_P).norm();
    ++points;
    lost += miss_mm > 0.05 ? 1 : 0;
  });
  EXPECT_LT(static_cast<double>(lost), 0.002 * static_cast<double>(points));
}

/// Beside the liver, at the inner wall, the tissue slides by most of the liver's motion; across the border it hardly
/// parts or overlaps.
TEST(BreathingModel, SlidesAtTheInnerWall) {
  const motion::MotionModel& model = *abdomen().motion;
  const motion::MotionModel::Scalars deep{1.0, 1.0};
  const std::uint8_t liver = abdomen().label_table.find("liver")->id;
  double slide_mm = 0.0, gap_mm = 0.0, worst_mm = 0.0, count = 0.0;
  for_body([&](std::uint8_t label, const Vec3& p_A) {
    if (label != liver || model.depth_mm(p_A) > 2.0) return;
    const Vec3 normal = volume::gradient_per_mm(model.parts().border_mm, p_A).normalized();
    const Vec3 apart = model.displacement_mm(1, p_A, deep) - model.displacement_mm(0, p_A, deep);
    slide_mm += (apart - normal.dot(apart) * normal).norm();
    gap_mm += std::abs(normal.dot(apart));
    worst_mm = std::max(worst_mm, std::abs(normal.dot(apart)));
    count += 1.0;
  });
  ASSERT_GT(count, 50.0);
  EXPECT_GT(slide_mm / count, 12.0);
  EXPECT_LT(gap_mm / count, 2.0);
  EXPECT_LT(worst_mm, 12.0);
}

TEST(BreathingModel, CountsFromTheCtsPhase) {
  const auto model = make_breathing_model(abdomen(), {10.0});
  ASSERT_TRUE(model) << model.error().text();
  const motion::PatientMotion expired(model->get(), motion::MotionState());
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  const std::uint8_t liver = abdomen().label_table.find("liver")->id;
  for_body([&](std::uint8_t label, const Vec3& p_A) {
    if (label != liver) return;
    sum += expired.to_now(p_A) - p_A;
    count += 1.0;
  });
  EXPECT_NEAR(sum.z() / count, 10.0, 0.5) << "at end-expiration the liver is higher than in this CT";
}

TEST(BreathingModel, IsTheSameEachTime) {
  const auto again = make_breathing_model(abdomen());
  ASSERT_TRUE(again);
  EXPECT_EQ((*again)->hash(), abdomen().motion->hash());
}

TEST(BreathingModel, RefusesAPatientWithoutOrgansOrBones) {
  for (const bool has_bones : {true, false}) {
    anatomy::VirtualPatient patient = abdomen();
    patient.motion = nullptr;
    std::array<bool, 256> is_removed{};
    for (const anatomy::Label& label : patient.label_table.labels) {
      const bool is_bone = label.tissue == "bone" || label.tissue == "cartilage";
      is_removed[label.id] = has_bones ? !is_bone : label.tissue != "liver";
    }
    for (std::uint8_t& voxel : patient.labels.voxels)
      if (is_removed[voxel]) voxel = 0;
    EXPECT_FALSE(make_breathing_model(patient)) << has_bones;
    add_breathing_model(patient);
    EXPECT_EQ(patient.motion, nullptr);
  }
}

}  // namespace
}  // namespace trocar::motion_builder
