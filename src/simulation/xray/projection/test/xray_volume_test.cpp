#include "xray/projection/xray_volume.h"

#include <gtest/gtest.h>

#include <cmath>

#include "xray/physics/beam.h"
#include "xray/physics/materials.h"

namespace trocar::xray {
namespace {

constexpr std::int16_t kAir = -1000, kWater = 0;

/// HU of cortical bone of 1.85 g/cm³ in a CT of 70 keV.
std::int16_t cortical_hu() {
  const auto of = [](Basis basis) { return attenuation_cm2_per_g(composition_of(basis), 70.0); };
  return static_cast<std::int16_t>(std::lround(1000.0 * (1.85 * of(Basis::kBone) / of(Basis::kWater) - 1.0)));
}

volume::CtGrid air(std::int64_t size, double spacing_mm) {
  volume::GridGeometry g;
  g.size = {size, size, size};
  g.spacing_mm = Vec3::Constant(spacing_mm);
  g.origin_P = Vec3::Constant(-0.5 * spacing_mm * static_cast<double>(size - 1));
  return volume::CtGrid(g, kAir);
}

/// Cylinder of water of 80 mm along z, its rim by its share of a voxel.
constexpr double kRadius_mm = 80.0;
volume::CtGrid cylinder() {
  volume::CtGrid ct = air(90, 2.0);
  for (std::size_t n = 0; n < ct.voxels.size(); ++n) {
    const Vec3 p = ct.geometry.centre_mm(ct.geometry.index_of(n));
    const double share = std::clamp(0.5 + (kRadius_mm - std::hypot(p.x(), p.y())) / 2.0, 0.0, 1.0);
    ct.voxels[n] = static_cast<std::int16_t>(std::lround(kAir + 1000.0 * share));
  }
  return ct;
}

struct View {
  XrayRays rays;
  MassImage masses;
  double mass(Basis basis, int column, int row) const {
    return static_cast<double>(masses.of(basis)[static_cast<std::size_t>(row * rays.columns + column)]);
  }
};
View look(const volume::CtGrid& ct, const CArm& arm) {
  View view{rays_of(arm), {}};
  project(**XrayVolume::from_ct(ct), view.rays, view.masses);
  return view;
}

double cylinder_chord_cm(const XrayRays& rays, int column, int row) {
  const Vec3 d = (rays.pixel_P(column, row) - rays.source_P).normalized();
  const double across = std::hypot(d.x(), d.y());
  const double offset = (rays.source_P.x() * d.y() - rays.source_P.y() * d.x()) / across;
  return 0.2 * std::sqrt(std::max(0.0, kRadius_mm * kRadius_mm - offset * offset)) / across;
}

TEST(XrayVolume, WaterCylinderMatchesTheClosedForm) {
  const Beam one = *Beam::make(*one_energy(60.0)), tube = *Beam::make(*tube_spectrum({.kv = 80.0}));
  for (const double lao : {0.0, 45.0, 90.0}) {
    const View view = look(cylinder(), {.lao_deg = lao, .field_mm = 260.0, .pixels = 65});
    std::vector<float> mono(view.masses.size()), poly(view.masses.size());
    one.signals(view.masses, mono);
    tube.signals(view.masses, poly);
    for (int row = 16; row < 48; row += 4)  // the cylinder's ends are farther away
      for (int column = 10; column < 55; ++column) {
        const double water = cylinder_chord_cm(view.rays, column, row);
        if (water < 6.0) continue;
        EXPECT_NEAR(view.mass(Basis::kWater, column, row), water, 0.01 * water) << lao;
        const auto n = static_cast<std::size_t>(row * 65 + column);
        const double by_table = 0.2059 * water;  // NIST, 60 keV
        EXPECT_NEAR(-std::log(static_cast<double>(mono[n])), by_table, 0.01 * by_table);
        const double hardened = -std::log(tube.signal({water, 0, 0, 0}));
        EXPECT_NEAR(-std::log(static_cast<double>(poly[n])), hardened, 0.01 * hardened);
      }
  }
}

TEST(XrayVolume, ShowsTheHardeningOfTheBeam) {
  // Per centimetre, the middle of the cylinder attenuates less than its side, and not so for one energy.
  const View view = look(cylinder(), {.field_mm = 260.0, .pixels = 65});
  const auto per_cm = [&](const Beam& beam, int column) {
    std::vector<float> signal(view.masses.size());
    beam.signals(view.masses, signal);
    return -std::log(static_cast<double>(signal[static_cast<std::size_t>(32 * 65 + column)])) /
           view.mass(Basis::kWater, column, 32);
  };
  int side = 0;
  while (view.mass(Basis::kWater, side, 32) < 4.0) ++side;
  const Beam tube = *Beam::make(*tube_spectrum({.kv = 80.0})), one = *Beam::make(*one_energy(60.0));
  EXPECT_LT(per_cm(tube, 32), 0.97 * per_cm(tube, side));
  EXPECT_NEAR(per_cm(one, 32), per_cm(one, side), 1e-4);
}

TEST(XrayVolume, ProjectsAStepWedgeOfBone) {
  // Steps of 10, 20, 30, 40 mm of cortical bone, 30 mm wide, seen from the front.
  volume::CtGrid ct = air(120, 1.0);
  const std::int16_t bone_hu = cortical_hu();
  for (std::size_t n = 0; n < ct.voxels.size(); ++n) {
    const volume::Index3 ijk = ct.geometry.index_of(n);
    const std::int64_t step = ijk[0] / 30;
    if (ijk[1] >= 20 && ijk[1] < 20 + 10 * (step + 1)) ct.voxels[n] = bone_hu;
  }
  const CArm arm{.field_mm = 150.0, .pixels = 75};
  const View view = look(ct, arm);
  const Beam one = *Beam::make(*one_energy(60.0)), tube = *Beam::make(*tube_spectrum({.kv = 80.0}));
  std::vector<float> mono(view.masses.size()), poly(view.masses.size());
  one.signals(view.masses, mono);
  tube.signals(view.masses, poly);
  for (int step = 0; step < 4; ++step) {
    const auto at = view.rays.project({-45.0 + 30.0 * step, -30.0, 0.0});
    const int column = static_cast<int>(std::lround(at[0])), row = 37;
    const Vec3 d = (view.rays.pixel_P(column, row) - view.rays.source_P).normalized();
    const double bone = 1.85 * (step + 1) / std::abs(d.y());
    EXPECT_NEAR(view.mass(Basis::kBone, column, row), bone, 0.01 * bone);
    const auto n = static_cast<std::size_t>(row * 75 + column);
    EXPECT_NEAR(-std::log(static_cast<double>(mono[n])), 0.3102 * bone, 0.01 * 0.3102 * bone);
    const double hardened = -std::log(tube.signal({0, bone, 0, 0}));
    EXPECT_NEAR(-std::log(static_cast<double>(poly[n])), hardened, 0.01 * hardened);
  }
}

TEST(XrayVolume, ProjectsATubeOfIodineInWater) {
  // 10 mm of 300 mg/ml in 160 mm of water: as a grid of the agent over the body.
  const CArm arm{.field_mm = 260.0, .pixels = 65};
  View view = look(cylinder(), arm);
  volume::GridGeometry g;
  g.size = {60, 60, 60};
  g.spacing_mm = Vec3::Constant(0.5);
  g.origin_P = Vec3::Constant(-14.75);
  volume::FloatGrid iodine(g);
  for (std::size_t n = 0; n < iodine.voxels.size(); ++n) {
    const Vec3 p = g.centre_mm(g.index_of(n));
    const double share = std::clamp(0.5 + (5.0 - std::hypot(p.x(), p.y())) / 0.5, 0.0, 1.0);
    iodine.voxels[n] = static_cast<float>(0.3 * share);  // g/ml
  }
  project(iodine, view.rays, view.masses.of(Basis::kIodine));
  const double expected = 0.3 * 1.0;
  EXPECT_NEAR(view.mass(Basis::kIodine, 32, 32), expected, 0.01 * expected);
  const double water = cylinder_chord_cm(view.rays, 32, 32);
  std::vector<float> signal(view.masses.size());
  Beam::make(*one_energy(60.0))->signals(view.masses, signal);
  const double mono = 0.2059 * water + 7.577 * expected;
  EXPECT_NEAR(-std::log(static_cast<double>(signal[32 * 65 + 32])), mono, 0.01 * mono);
  const Beam tube = *Beam::make(*tube_spectrum({.kv = 80.0}));
  tube.signals(view.masses, signal);
  const double poly = -std::log(tube.signal({water, 0, expected, 0}));
  EXPECT_NEAR(-std::log(static_cast<double>(signal[32 * 65 + 32])), poly, 0.01 * poly);
}

TEST(XrayVolume, ExcludesObjectsOutsideTheBody) {
  auto patient = std::make_shared<anatomy::VirtualPatient>();
  patient->ct = air(40, 5.0);
  patient->skin_distance_mm = volume::FloatGrid(patient->ct.geometry, 20.0F);
  patient->labels = volume::LabelGrid(patient->ct.geometry);
  for (std::size_t n = 0; n < patient->ct.voxels.size(); ++n) {
    const volume::Index3 ijk = patient->ct.geometry.index_of(n);
    if (ijk[1] >= 35) patient->ct.voxels[n] = kWater;  // a table behind
    if (ijk[1] < 10 || ijk[1] >= 30) continue;
    patient->ct.voxels[n] = kWater;
    patient->skin_distance_mm.voxels[n] = -10.0F;
  }
  const auto volume = XrayVolume::make(patient);
  ASSERT_TRUE(volume) << volume.error().text();
  View view{rays_of({.field_mm = 100.0, .pixels = 33}), {}};
  project(**volume, view.rays, view.masses);
  const double at_60 = view.mass(Basis::kWater, 16, 16) * 0.2059 + view.mass(Basis::kBone, 16, 16) * 0.3102;
  EXPECT_NEAR(at_60, 10.0 * 0.2059, 0.01 * 10.0 * 0.2059);
  EXPECT_TRUE((*volume)->is_inside_body({0, 0, 0}));
  EXPECT_FALSE((*volume)->is_inside_body({0, 90, 0}));
}

TEST(XrayVolume, RefusesAPatientWithoutCt) {
  const auto none = XrayVolume::make(std::make_shared<anatomy::VirtualPatient>());
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().what.find("no CT"), std::string::npos);
  EXPECT_FALSE(XrayVolume::make(nullptr));
  EXPECT_FALSE(XrayVolume::from_ct({}));
}

TEST(CheckSource, RefusesASourceOrADetectorInsideTheBody) {
  volume::CtGrid ct = air(60, 20.0);  // a body of 600 mm
  for (std::size_t n = 0; n < ct.voxels.size(); ++n)
    if (ct.geometry.centre_mm(ct.geometry.index_of(n)).norm() < 380.0) ct.voxels[n] = kWater;
  const auto volume = *XrayVolume::from_ct(ct);
  EXPECT_TRUE(check_source(*volume, {.source_isocentre_mm = 700.0, .source_detector_mm = 1150.0}));
  const Status source = check_source(*volume, {.source_isocentre_mm = 320.0, .source_detector_mm = 900.0});
  ASSERT_FALSE(source);
  EXPECT_NE(source.error().what.find("source"), std::string::npos);
  EXPECT_EQ(source.error().exit_status, 2);
  const Status detector = check_source(*volume, {.source_isocentre_mm = 700.0, .source_detector_mm = 900.0});
  ASSERT_FALSE(detector);
  EXPECT_NE(detector.error().what.find("detector"), std::string::npos);
  EXPECT_FALSE(check_source(*volume, {.pixels = 0}));
}

}  // namespace
}  // namespace trocar::xray
