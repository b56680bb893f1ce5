#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "patient_builder/derive/derive_structures.h"
#include "patient_builder/test/labelled_box.h"
#include "volume/morphology.h"

namespace trocar::patient_builder {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Peritoneum, IsAThinClosedShellAroundTheCavity) {
  constexpr double kRadiusMm = 30.0;
  LabelledBox box({91, 91, 91}, {-45.0, -45.0, -45.0});
  box.paint("liver", [](const Vec3& p) { return p.norm() <= kRadiusMm; });
  derive_structures(box.patient, box.known, {false, {"peritoneum"}});
  // Membrane of 1.2 mm; with voxels of 1 mm one or two voxels on any line through the centre.
  const double shell_mm3 = 4.0 / 3.0 * kPi * (std::pow(kRadiusMm + 1.7, 3) - std::pow(kRadiusMm + 0.3, 3));
  EXPECT_NEAR(static_cast<double>(box.count("peritoneum")), shell_mm3, 0.25 * shell_mm3);
  for (int n = 0; n < 200; ++n) {  // directions on a spiral
    const double z = -1.0 + (n + 0.5) / 100.0, angle = 2.4 * n;
    const Vec3 way(std::sqrt(1.0 - z * z) * std::cos(angle), std::sqrt(1.0 - z * z) * std::sin(angle), z);
    bool is_crossed = false;
    for (double r = 40.0; r > 20.0; r -= 0.05) is_crossed = is_crossed || box.name_at(r * way) == "peritoneum";
    EXPECT_TRUE(is_crossed) << way.transpose();
  }
}

TEST(Peritoneum, DoesNotSeparateTheOrgansOfTheCavity) {
  LabelledBox box({121, 81, 81}, {-60.0, -40.0, -40.0}, "fat");
  box.paint("liver", [](const Vec3& p) { return (p - Vec3(-22.0, 0.0, 0.0)).norm() <= 20.0; });
  box.paint("stomach", [](const Vec3& p) { return (p - Vec3(22.0, 0.0, 0.0)).norm() <= 20.0; });
  derive_structures(box.patient, box.known, {false, {"peritoneum"}});
  EXPECT_EQ(box.name_at({0.0, 0.0, 0.0}), "fat");  // 4 mm of fat between the two
  EXPECT_EQ(box.name_at({-43.0, 0.0, 0.0}), "peritoneum");
}

/// A liver under a lung inside ribs: horizontal bars around it, 20 mm apart.
LabelledBox make_chest() {
  LabelledBox box({141, 141, 161}, {-70.0, -70.0, -80.0});
  const volume::GridGeometry& g = box.patient.labels.geometry;
  for (std::size_t n = 0; n < g.voxel_count(); ++n) {
    const volume::Index3 ijk = g.index_of(n);
    const Vec3 p_P = g.centre_mm(ijk);
    box.patient.skin_distance_mm.voxels[n] = static_cast<float>(std::hypot(p_P.x(), p_P.y()) - 65.0);
  }
  box.paint("liver", [](const Vec3& p) { return std::hypot(p.x(), p.y()) <= 42.0 && p.z() < 40.0; });
  box.paint("lung_lower_lobe_right", [](const Vec3& p) { return std::hypot(p.x(), p.y()) <= 45.0 && p.z() >= 44.0; });
  for (int n = 0; n < 8; ++n)
    box.paint("bone", [n](const Vec3& p) {
      const double r = std::hypot(p.x(), p.y());
      return r >= 50.0 && r <= 55.0 && std::abs(p.z() - (-70.0 + 20.0 * n)) <= 4.0;
    });
  return box;
}

TEST(PleuralRecess, ReachesUpTo50MmBelowTheLung) {
  LabelledBox box = make_chest();
  derive_structures(box.patient, box.known, {false, {"pleural_recess"}});
  double lowest = 1e9, highest = -1e9, nearest = 1e9;
  for (const char* name : {"pleural_recess_left", "pleural_recess_right"}) {
    ASSERT_GT(box.count(name), 1000U) << name;
    box.for_each(name, [&](const Vec3& p) {
      const double r = std::hypot(p.x(), p.y());
      if (p.z() < 36.0) nearest = std::min(nearest, r);  // at the liver's side, not over its upper edge
      EXPECT_LT(r, 50.0);
      EXPECT_EQ(p.x() > 0.0, std::string(name).ends_with("left"));
      lowest = std::min(lowest, p.z());
      highest = std::max(highest, p.z());
    });
  }
  EXPECT_GT(nearest, 42.0 + 1.5);  // 3 mm of diaphragm, found on cells of 4 mm
  EXPECT_NEAR(lowest, 44.0 - 50.0, 4.0);
  EXPECT_LE(highest, 48.0);
}

TEST(PleuralRecess, NeedsALung) {
  LabelledBox box = make_chest();
  box.paint("muscle", [](const Vec3& p) { return std::hypot(p.x(), p.y()) <= 45.0 && p.z() >= 44.0; });
  derive_structures(box.patient, box.known, {false, {"pleural_recess"}});
  EXPECT_EQ(box.patient.label_table.find("pleural_recess_right"), nullptr);
}

TEST(NeurovascularBundle, LiesBelowTheInnerHalfOfARib) {
  LabelledBox box({101, 61, 41}, {-50.0, 0.0, -20.0});
  box.paint("rib_right_9", [](const Vec3& p) { return std::abs(p.y() - 20.0) <= 4.0 && std::abs(p.z()) <= 6.0; });
  derive_structures(box.patient, box.known, {false, {"neurovascular_bundle"}});
  ASSERT_GT(box.count("neurovascular_bundle"), 0U);
  double inner = -1e9, outer = 1e9;
  box.for_each("neurovascular_bundle", [&](const Vec3& p) {
    EXPECT_LT(p.z(), -6.0);
    EXPECT_GE(p.z(), -10.0);  // 4 mm
    inner = std::max(inner, p.y());
    outer = std::min(outer, p.y());
  });
  EXPECT_GE(outer, 18.0);  // of 16 to 24; the skin is at y = 0
  EXPECT_NEAR(inner, 24.0, 1.0);
}

/// An oblique rib around a chest of 90 mm radius, from the back to the front of the right side: 30 mm lower in front.
/// Slices of 5 mm.
LabelledBox make_thick_slices() {
  LabelledBox box({160, 260, 14}, {-110.0, -115.0, -35.0});
  volume::GridGeometry g = box.patient.labels.geometry;
  g.spacing_mm = {0.8, 0.9, 5.0};
  box.patient.labels.geometry = g;
  box.patient.ct.geometry = g;
  box.patient.skin_distance_mm.geometry = g;
  for (std::size_t n = 0; n < g.voxel_count(); ++n) {
    const Vec3 p_P = g.centre_mm(g.index_of(n));
    box.patient.skin_distance_mm.voxels[n] = static_cast<float>(std::hypot(p_P.x(), p_P.y()) - 105.0);
  }
  box.paint("rib_right_9", [](const Vec3& p) {
    const double r = std::hypot(p.x(), p.y());
    return p.x() < 0.0 && r >= 90.0 && r <= 97.0 && std::abs(p.z() - p.y() / 6.0) <= 6.0;
  });
  return box;
}

volume::MaskGrid mask_of(const LabelledBox& box, const std::string& name) {
  volume::MaskGrid mask(box.patient.labels.geometry);
  for (std::size_t n = 0; n < mask.voxels.size(); ++n)
    mask.voxels[n] = box.patient.labels.voxels[n] == box.id_of(name) ? 1 : 0;
  return mask;
}

TEST(NeurovascularBundle, IsOneTubeAlongTheRibInThickSlices) {
  LabelledBox box = make_thick_slices();
  derive_structures(box.patient, box.known, {false, {"neurovascular_bundle"}});
  const volume::MaskGrid bundle = mask_of(box, "neurovascular_bundle");
  const volume::Components parts = volume::connected_components(bundle);  // by faces
  ASSERT_FALSE(parts.voxel_counts.empty());
  EXPECT_EQ(parts.voxel_counts.size(), 1U);
  // At each angle of the rib: below its border, on its inner side, some 4 mm wide.
  for (double angle = 0.52 * kPi; angle < 1.48 * kPi; angle += 0.01 * kPi) {
    const double border_z = 92.0 * std::sin(angle) / 6.0 - 6.0;
    double inner = 1e9, outer = -1e9;
    for (double r = 84.0; r <= 100.0; r += 0.2)
      for (double z = border_z - 10.0; z <= border_z + 2.5; z += 1.0) {
        const Vec3 p(r * std::cos(angle), r * std::sin(angle), z);
        if (box.name_at(p) != "neurovascular_bundle") continue;
        inner = std::min(inner, r);
        outer = std::max(outer, r);
      }
    EXPECT_GE(inner, 87.0) << angle;
    EXPECT_LE(outer, 96.0) << angle;
    EXPECT_GE(outer - inner, 2.0) << angle;
  }
  // Some 290 mm of a tube of 4 mm that fills its slices of 5 mm, about one and a half of them where it is oblique.
  const double ml =
      static_cast<double>(box.count("neurovascular_bundle")) * bundle.geometry.voxel_volume_mm3() / 1000.0;
  EXPECT_GT(ml, 0.7 * 290.0 * 4.0 * 5.0 / 1000.0);
  EXPECT_LT(ml, 2.0 * 290.0 * 4.0 * 5.0 / 1000.0);
}

TEST(NeurovascularBundle, EndsAtAWideGapOfTheRib) {
  LabelledBox box = make_thick_slices();
  box.paint("muscle", [](const Vec3& p) { return std::abs(p.y()) < 25.0; });
  derive_structures(box.patient, box.known, {false, {"neurovascular_bundle"}});
  const volume::Components parts = volume::connected_components(mask_of(box, "neurovascular_bundle"));
  EXPECT_EQ(parts.voxel_counts.size(), 2U);
}

TEST(EpigastricZone, LiesBehindTheMuscle4To8CmFromTheMidline) {
  LabelledBox box({241, 61, 141}, {-120.0, 0.0, 0.0}, "fat");
  box.paint("muscle", [](const Vec3& p) { return p.y() >= 15.0 && p.y() <= 24.0; });
  box.paint("hip_left",
            [](const Vec3& p) { return p.x() >= 60.0 && p.x() <= 110.0 && p.y() >= 50.0 && p.z() <= 80.0; });
  box.paint("hip_right",
            [](const Vec3& p) { return p.x() <= -60.0 && p.x() >= -110.0 && p.y() >= 50.0 && p.z() <= 80.0; });
  derive_structures(box.patient, box.known, {false, {"inferior_epigastric_zone"}});
  ASSERT_GT(box.count("inferior_epigastric_zone_left"), 0U);
  EXPECT_EQ(box.count("inferior_epigastric_zone_left"), box.count("inferior_epigastric_zone_right"));
  EXPECT_EQ(box.count("inferior_epigastric_zone_left"), 41U * 4U * 61U);  // 4..8 cm, 4 mm, symphysis to umbilicus
  box.for_each("inferior_epigastric_zone_left", [](const Vec3& p) {
    EXPECT_GE(p.x(), 40.0);
    EXPECT_LE(p.x(), 80.0);
    EXPECT_GE(p.y(), 21.0);
    EXPECT_LE(p.y(), 24.0);
    EXPECT_GE(p.z(), 40.0);
    EXPECT_LE(p.z(), 100.0);
  });
}

// A portal branch of radius 5 mm along x: the duct has 40 % of it and lies in front (lower y), 0.5 mm from it.
TEST(BileDucts, RunInFrontOfThePortalVeinAtAFractionOfItsRadius) {
  LabelledBox box({61, 41, 41}, {-30.0, -20.0, -20.0});
  box.paint("liver", [](const Vec3& p) { return std::abs(p.x()) <= 28.0; });
  box.paint("portalvein", [](const Vec3& p) { return std::hypot(p.y(), p.z()) <= 5.0 && std::abs(p.x()) <= 28.0; });
  derive_structures(box.patient, box.known, {false, {"bile_ducts"}});
  const double voxels = static_cast<double>(box.count("bile_ducts"));
  const double radius_mm = 0.4 * 4.6;  // voxels within 5 mm of a line have a surface 4.6 mm from it
  const double expected = kPi * radius_mm * radius_mm * 50.0;
  EXPECT_NEAR(voxels, expected, 0.25 * expected);
  Vec3 middle = Vec3::Zero();
  box.for_each("bile_ducts", [&](const Vec3& p) {
    middle += p / voxels;
    EXPECT_GT(std::hypot(p.y(), p.z()), 5.0);
  });
  EXPECT_NEAR(middle.y(), -(5.0 + 0.5 + 2.0), 1.0);
  EXPECT_NEAR(middle.z(), 0.0, 0.5);
  for (double x = -20.0; x <= 20.0; x += 1.0)
    EXPECT_EQ(box.name_at({x, std::round(middle.y()), 0.0}), "bile_ducts") << x;
}

}  // namespace
}  // namespace trocar::patient_builder
