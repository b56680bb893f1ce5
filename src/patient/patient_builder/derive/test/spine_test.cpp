#include <gtest/gtest.h>

#include <cmath>

#include "patient_builder/derive/derive_structures.h"
#include "patient_builder/detail/label_boxes.h"
#include "patient_builder/test/labelled_box.h"

namespace trocar::patient_builder {
namespace {

constexpr double kPitchMm = 32.0;      // from one vertebra to the next
constexpr double kHalfLaminaMm = 9.0;  // half the height of a lamina: a gap of 14 mm follows
constexpr double kApexMm = 9.0;        // the inner face of a lamina in the midline
constexpr double kSlope = 0.5;         // it comes forward to the sides

double face_y(double x) {
  return kApexMm - kSlope * std::abs(x);
}

/// Vertebrae L1 (top) to L4 with bodies, pedicles, laminae in a V and spinous processes; k runs to the head.
LabelledBox make_spine(bool has_cord) {
  LabelledBox box({61, 101, 141}, {-30.0, -40.0, 0.0});
  for (int n = 0; n < 4; ++n) {
    const double z0 = 22.0 + kPitchMm * n;
    const std::string name = "vertebrae_L" + std::to_string(4 - n);
    box.paint(name, [&](const Vec3& p) {
      const double x = std::abs(p.x()), z = std::abs(p.z() - z0);
      const bool body = x <= 20.0 && p.y() >= -35.0 && p.y() <= -10.0 && z <= 13.0;
      const bool pedicle = x >= 11.0 && x <= 16.0 && p.y() > -10.0 && p.y() <= face_y(x) + 5.0 && z <= kHalfLaminaMm;
      const bool lamina = x <= 11.0 && p.y() >= face_y(x) && p.y() <= face_y(x) + 5.0 && z <= kHalfLaminaMm;
      const bool spinous = x <= 2.5 && p.y() >= kApexMm && p.y() <= 42.0 && z <= 8.0;
      return body || pedicle || lamina || spinous;
    });
  }
  // Fat around the sac; all else has 40 HU.
  const volume::GridGeometry& g = box.patient.ct.geometry;
  for (std::size_t n = 0; n < g.voxel_count(); ++n) {
    const Vec3 p_P = g.centre_mm(g.index_of(n));
    if (std::abs(p_P.x()) <= 11.0 && p_P.y() > 0.0 && p_P.y() < face_y(p_P.x())) box.patient.ct.voxels[n] = -90;
  }
  if (has_cord)
    box.paint("spinal_cord", [](const Vec3& p) { return std::hypot(p.x() / 8.0, (p.y() + 1.0) / 6.5) <= 1.0; });
  return box;
}

LabelledBox derived(bool has_cord, const DeriveChoice& choice = {}) {
  LabelledBox box = make_spine(has_cord);
  derive_structures(box.patient, box.known, choice);
  return box;
}

TEST(SpineLabels, OrderVertebraeByName) {
  EXPECT_EQ(detail::vertebra_place("vertebrae_C1"), 1);
  EXPECT_EQ(detail::vertebra_place("vertebrae_T12"), detail::kL1 - 1);
  EXPECT_EQ(detail::vertebra_place("Vertebra L5"), detail::kL5);
  EXPECT_EQ(detail::vertebra_place("sacrum"), detail::kSacrum);
  for (const char* other : {"vertebrae", "vertebrae_body", "vertebrae_T13", "rib_left_7", "vertebrae_L", "liver"})
    EXPECT_EQ(detail::vertebra_place(other), 0) << other;
  EXPECT_TRUE(detail::are_neighbours(detail::kL5, detail::kS1));
  EXPECT_TRUE(detail::are_neighbours(detail::kL5, detail::kSacrum));
  EXPECT_FALSE(detail::are_neighbours(detail::kS1, detail::kSacrum));
  EXPECT_FALSE(detail::are_neighbours(detail::kL1, detail::kL1 + 2));
}

TEST(LigamentumFlavum, FillsOnlyTheGapsBetweenLaminae) {
  const LabelledBox box = derived(true);
  ASSERT_GT(box.count("ligamentum_flavum"), 0U);
  box.for_each("ligamentum_flavum", [](const Vec3& p) {
    const double z = std::remainder(p.z() - 22.0, kPitchMm);  // from the nearest vertebra's middle
    EXPECT_GT(std::abs(z), kHalfLaminaMm) << p.transpose();
  });
  for (const double z : {38.0, 70.0, 102.0})
    for (const double x : {-8.0, -4.0, 0.0, 4.0, 8.0})
      EXPECT_EQ(box.name_at({x, face_y(x) + 1.0, z}), "ligamentum_flavum");
}

// L2-L3 and L3-L4: 3.19 and 3.38 mm along the normal, 1.12 times that along y on the sides; voxels of 1 mm.
TEST(LigamentumFlavum, HasThePublishedThicknessAndVShape) {
  const LabelledBox box = derived(true);
  for (const double z : {38.0, 70.0})
    for (const double x : {-6.0, 0.0, 6.0}) {
      int voxels = 0;
      double first = 1e9;
      for (double y = -5.0; y < 20.0; y += 1.0)
        if (box.name_at({x, y, z}) == "ligamentum_flavum") {
          ++voxels;
          first = std::min(first, y);
        }
      EXPECT_GE(voxels, 3) << x << " " << z;
      EXPECT_LE(voxels, 4) << x << " " << z;
      EXPECT_NEAR(first, face_y(x), 1.0) << x << " " << z;
    }
}

TEST(DuralSac, IsTheCordBelowL1AndSurroundsItAbove) {
  const LabelledBox whole = make_spine(true);
  const LabelledBox box = derived(true, {false, {"dural_sac"}});
  EXPECT_EQ(box.count("dural_sac") + box.count("spinal_cord"), whole.count("spinal_cord"));
  EXPECT_EQ(box.name_at({0.0, -1.0, 60.0}), "dural_sac");
  EXPECT_EQ(box.name_at({0.0, -1.0, 135.0}), "spinal_cord");
  EXPECT_EQ(box.name_at({6.0, -1.0, 135.0}), "dural_sac");
  // The cord ends in the middle of L1 (z 118) and L2 (z 86).
  box.for_each("spinal_cord", [](const Vec3& p) {
    EXPECT_GE(p.z(), 101.0);
    EXPECT_LE(std::hypot(p.x() / 4.5, (p.y() + 1.0) / 4.0), 1.0 + 1e-9);
  });
  EXPECT_FALSE(box.patient.label_table.find("spinal_cord")->is_derived);
  EXPECT_TRUE(box.patient.label_table.find("dural_sac")->is_derived);
}

// The rings have their laminae at y = 9 and bodies at y = -10: 3 mm are left free behind the sac, 1 mm in front.
TEST(DuralSac, IsFoundFromTheVertebraeAlone) {
  const LabelledBox box = derived(false, {false, {"dural_sac"}});
  for (const double z : {30.0, 38.0, 54.0, 70.0}) {
    double low_x = 1e9, high_x = -1e9, low_y = 1e9, high_y = -1e9;
    box.for_each("dural_sac", [&](const Vec3& p) {
      if (p.z() != z) return;
      low_x = std::min(low_x, p.x());
      high_x = std::max(high_x, p.x());
      low_y = std::min(low_y, p.y());
      high_y = std::max(high_y, p.y());
    });
    EXPECT_NEAR(0.5 * (low_x + high_x), 0.0, 0.6) << z;
    EXPECT_NEAR(high_x - low_x + 1.0, 17.0, 1.6) << z;  // published width
    EXPECT_NEAR(high_y - low_y + 1.0, 14.0, 1.6) << z;  // published depth
    EXPECT_LE(high_y, kApexMm - 3.0 + 0.5) << z;
    EXPECT_GE(low_y, -10.0) << z;
  }
}

TEST(EpiduralFat, FillsTheSpaceBetweenSacAndFlavum) {
  const LabelledBox box = derived(true);
  for (const double z : {38.0, 70.0}) {
    int fat = 0;
    for (double y = -8.0; y < face_y(0.0) - 0.5; y += 1.0) fat += box.name_at({0.0, y, z}) == "epidural_fat" ? 1 : 0;
    EXPECT_GE(fat, 3) << z;
    EXPECT_LE(fat, 6) << z;
  }
  box.for_each("epidural_fat", [](const Vec3& p) { EXPECT_LT(p.y(), face_y(p.x()) + 1.0); });
}

// Voxels at the bone contain a part of it: at 300 HU of lamina and flavum's edge they are no fat, and the rest still
// is.
TEST(EpiduralFat, LeavesOutVoxelsThatContainBone) {
  LabelledBox box = make_spine(true);
  const volume::GridGeometry& g = box.patient.ct.geometry;
  const auto set_hu = [&](std::int16_t hu, const auto& is_inside) {
    for (std::size_t n = 0; n < g.voxel_count(); ++n)
      if (is_inside(g.centre_mm(g.index_of(n)))) box.patient.ct.voxels[n] = hu;
  };
  set_hu(300, [](const Vec3& p) { return std::abs(p.x()) <= 11.0 && std::abs(p.y() - face_y(p.x())) <= 1.0; });
  derive_structures(box.patient, box.known, {});
  double sum = 0.0, count = 0.0;
  box.for_each("epidural_fat", [&](const Vec3& p) {
    const Vec3 index = g.to_index(p);
    const int hu = box.patient.ct[{std::lround(index.x()), std::lround(index.y()), std::lround(index.z())}];
    EXPECT_LE(hu, 30) << p.transpose();
    sum += hu;
    count += 1.0;
  });
  ASSERT_GT(count, 0.0);
  EXPECT_LT(sum / count, -30.0);
  for (const double z : {38.0, 70.0}) {
    int fat = 0;
    for (double y = -8.0; y < face_y(0.0); y += 1.0) fat += box.name_at({0.0, y, z}) == "epidural_fat" ? 1 : 0;
    EXPECT_GE(fat, 2) << z;
  }
}

TEST(EpiduralFat, ExcludesVoxelsThatCannotBeFat) {
  LabelledBox box = make_spine(true);
  box.patient.ct = volume::CtGrid(box.patient.ct.geometry, 40);
  derive_structures(box.patient, box.known, {});
  EXPECT_EQ(box.patient.label_table.find("epidural_fat"), nullptr);
  EXPECT_GT(box.count("dural_sac"), 0U);
}

// The bodies end at y = -10; the sac of the vertebrae alone leaves 1 mm in front of it. Between the bodies the veins
// reach up to 4 mm in front of the sac.
TEST(EpiduralVeins, LieBetweenTheSacAndTheBodies) {
  const LabelledBox box = derived(false);
  ASSERT_GT(box.count("epidural_veins"), 0U);
  EXPECT_TRUE(box.patient.label_table.find("epidural_veins")->is_derived);
  EXPECT_EQ(box.patient.label_table.find("epidural_veins")->tissue, "vessel");
  box.for_each("epidural_veins", [&](const Vec3& p) {
    EXPECT_LT(p.y(), 0.0);
    EXPECT_GE(p.y(), -10.0 - 4.0) << p.transpose();
    std::string behind = "epidural_veins";
    for (double y = p.y(); behind == "epidural_veins"; y += 1.0) behind = box.name_at({p.x(), y, p.z()});
    EXPECT_TRUE(behind == "dural_sac" || behind == "spinal_cord" || std::abs(p.x()) > 8.0) << p.transpose() << behind;
  });
}

TEST(SpinousLigaments, LieBetweenAndBehindTheSpinousProcesses) {
  const LabelledBox box = derived(true);
  for (const double z : {38.0, 70.0, 102.0}) {
    EXPECT_EQ(box.name_at({0.0, 25.0, z}), "interspinous_ligament") << z;
    EXPECT_EQ(box.name_at({0.0, 44.0, z}), "supraspinous_ligament") << z;
    EXPECT_EQ(box.name_at({5.0, 25.0, z}), "muscle") << z;
  }
  EXPECT_EQ(box.name_at({0.0, 44.0, 54.0}), "supraspinous_ligament");  // behind a process, too
  EXPECT_EQ(box.name_at({0.0, 48.0, 54.0}), "muscle");
  box.for_each("interspinous_ligament", [](const Vec3& p) { EXPECT_LE(std::abs(p.x()), 3.0); });
}

/// A needle in the midline passes the layers of a lumbar puncture in order.
TEST(DeriveStructures, CreateTheLayersOfALumbarPuncture) {
  const LabelledBox box = derived(true);
  std::vector<std::string> crossed;
  for (double y = 55.0; y > 0.0; y -= 0.5) {
    const std::string name = box.name_at({0.0, y, 70.0});
    if (crossed.empty() || crossed.back() != name) crossed.push_back(name);
  }
  EXPECT_EQ(crossed, (std::vector<std::string>{"muscle", "supraspinous_ligament", "interspinous_ligament",
                                               "ligamentum_flavum", "epidural_fat", "dural_sac"}));
}

TEST(DeriveStructures, ChangeNothingWithoutAChoice) {
  const LabelledBox before = make_spine(true);
  const LabelledBox after = derived(true, {false, {}});
  EXPECT_EQ(before.patient.labels.voxels, after.patient.labels.voxels);
  EXPECT_EQ(before.patient.label_table.labels.size(), after.patient.label_table.labels.size());
}

TEST(DeriveStructures, KeepSegmentedStructures) {
  LabelledBox box = make_spine(true);
  box.paint("ligamentum_flavum", [](const Vec3& p) { return (p - Vec3(0.0, 12.0, 70.0)).norm() < 1.5; });
  const std::size_t labelled = box.count("ligamentum_flavum");
  derive_structures(box.patient, box.known, {});
  EXPECT_EQ(box.count("ligamentum_flavum"), labelled);
  EXPECT_FALSE(box.patient.label_table.find("ligamentum_flavum")->is_derived);
}

TEST(DeriveStructures, CreateNothingForASingleVertebra) {
  LabelledBox box({41, 41, 41}, {0.0, 0.0, 0.0});
  box.paint("vertebrae_L3", [](const Vec3& p) { return (p - Vec3(20.0, 20.0, 20.0)).norm() < 10.0; });
  EXPECT_TRUE(derive_structures(box.patient, box.known, {}).empty());
}

TEST(DeriveChoice, ReadsAllNoneAndNames) {
  EXPECT_TRUE(parse_derive_choice("all")->has("peritoneum"));
  EXPECT_FALSE(parse_derive_choice("none")->has("peritoneum"));
  const auto some = parse_derive_choice("dural_sac,epidural_fat");
  ASSERT_TRUE(some);
  EXPECT_TRUE(some->has("epidural_fat"));
  EXPECT_FALSE(some->has("peritoneum"));
  for (const char* bad : {"", "liver", "dural_sac,", "all,none", "dural_sac epidural_fat"})
    EXPECT_FALSE(parse_derive_choice(bad)) << bad;
}

TEST(DeriveChoice, AllDerivableStructuresAreKnown) {
  EXPECT_TRUE(check_derived_names(trocar::testing::shipped_structures()));
}

}  // namespace
}  // namespace trocar::patient_builder
