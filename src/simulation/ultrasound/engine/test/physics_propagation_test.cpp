// What sound loses on its way and gives back at borders, against the numbers that were set.

#include "ultrasound/test/physics_lab.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

/// Slope of speckle's level in one tissue, dB/cm.
double slope_db_per_cm(TestTissue tissue, double frequency_mhz, const Artefacts& artefacts) {
  const Transducer transducer = convex();
  Acquisition acquisition = plain(transducer, artefacts);
  acquisition.frequency_mhz = frequency_mhz;
  BMode engine(homogeneous_scene(box_for(transducer, acquisition.depth_mm, 2.0), tissue), transducer, acquisition);
  const EchoPatch patch = envelope_patch(engine.render({}), {10, 246, 20.0, 140.0});
  return 10.0 * level_slope_db_per_mm(level_against_depth(patch, 5.0));
}

TEST(Attenuation, MatchesTheTableAtTwoFrequencies) {
  const AcousticTable table = test_table();
  for (const TestTissue tissue : {TestTissue::kTissue, TestTissue::kLossy})
    for (const double frequency_mhz : {2.5, 4.5}) {
      const double set = -2.0 * table.tissues[index_of(tissue)].attenuation_db_per_cm(frequency_mhz);
      const double measured = slope_db_per_cm(tissue, frequency_mhz, losses());
      EXPECT_NEAR(measured, set, 0.05 * std::abs(set));
    }
}

TEST(Attenuation, CanBeSwitchedOff) {
  EXPECT_NEAR(slope_db_per_cm(TestTissue::kLossy, 3.5, no_artefacts()), 0.0, 0.1);
}

/// Level in a cyst of that tissue against the same place without it, dB: the scatterers are the same.
double contrast_db(TestTissue inside) {
  const Transducer transducer = convex();
  constexpr double kRadius_mm = 10.0, kDepth_mm = 60.0, kInside_mm = 4.5;
  const SceneBox box = box_for(transducer, 100.0);
  const TestRod rods[] = {{0.0, kDepth_mm, kRadius_mm, inside}};
  Acquisition acquisition = plain(transducer, losses());
  acquisition.depth_mm = 100.0;
  BMode with(rods_scene(box, TestTissue::kTissue, rods), transducer, acquisition);
  BMode without(homogeneous_scene(box, TestTissue::kTissue), transducer, acquisition);
  const auto level = [&](BMode& engine) {
    return level_db(patch_at(engine.render({}), 0.0, kInside_mm, kDepth_mm - kInside_mm, kDepth_mm + kInside_mm));
  };
  return level(with) - level(without);
}

TEST(Cyst, HasTheContrastThatWasSet) {
  for (const auto& [tissue, set_db] : {std::pair{TestTissue::kMinus12, -12.0}, std::pair{TestTissue::kMinus6, -6.0},
                                       std::pair{TestTissue::kPlus6, 6.0}, std::pair{TestTissue::kPlus12, 12.0}}) {
    const double measured_db = contrast_db(tissue);
    EXPECT_NEAR(measured_db, set_db, 0.3) << set_db;
  }
}

TEST(Cyst, IsBlackIfFilledWithFluid) {
  const double measured_db = contrast_db(TestTissue::kWater);
  EXPECT_LT(measured_db, -35.0);
}

/// Level of what lies behind a thing against the same place without it, dB. The scatterers are the same.
double behind_against_without_db(const ScenePtr& with, const ScenePtr& without, const Artefacts& artefacts, double x_mm,
                                 double half_mm, double from_mm, double to_mm) {
  const Transducer transducer = convex();
  Acquisition acquisition = plain(transducer, artefacts);
  acquisition.depth_mm = 120.0;
  BMode a(with, transducer, acquisition), b(without, transducer, acquisition);
  const double with_db = level_db(patch_at(a.render({}), x_mm, half_mm, from_mm, to_mm));
  return with_db - level_db(patch_at(b.render({}), x_mm, half_mm, from_mm, to_mm));
}

TEST(Shadow, BehindBoneMatchesLossAndBorderReflections) {
  const Transducer transducer = convex();
  const SceneBox box = box_for(transducer, 120.0);
  constexpr double kThick_mm = 8.0, kLoss = 2.0;
  const auto softer = [&](AcousticTable& table) {
    table.tissues[index_of(TestTissue::kBone)].attenuation_db_per_cm_mhz = kLoss;
  };
  const ScenePtr with =
      with_table(slab_scene(box, TestTissue::kTissue, {15.0, 40.0, 40.0 + kThick_mm, TestTissue::kBone}), softer);
  const ScenePtr without = homogeneous_scene(box, TestTissue::kTissue);
  const double r = reflection(1.54, with->table.tissues[index_of(TestTissue::kBone)].impedance_mrayl());
  const double borders_db = 2.0 * 20.0 * std::log10(1.0 - r * r);
  const double expected_db = borders_db - 2.0 * 3.5 * (kLoss - 0.5) * 0.1 * kThick_mm;
  const double measured_db = behind_against_without_db(with, without, losses(), 0.0, 8.0, 60.0, 100.0);
  EXPECT_NEAR(measured_db, expected_db, 0.7);
  EXPECT_NEAR(behind_against_without_db(with, without, losses(), 45.0, 8.0, 60.0, 100.0), 0.0, 0.1) << "beside";
  EXPECT_NEAR(behind_against_without_db(with, without, no_artefacts(), 0.0, 8.0, 60.0, 100.0), 0.0, 0.3) << "off";
}

TEST(Shadow, BehindShippedBoneIsBlack) {
  const Transducer transducer = convex();
  const SceneBox box = box_for(transducer, 120.0);
  const TestRod rods[] = {{0.0, 45.0, 8.0, TestTissue::kBone}};
  const double measured_db =
      behind_against_without_db(rods_scene(box, TestTissue::kTissue, rods), homogeneous_scene(box, TestTissue::kTissue),
                                losses(), 0.0, 5.0, 65.0, 100.0);
  EXPECT_LT(measured_db, -40.0);
}

TEST(Enhancement, BehindFluidEqualsTheAvoidedLoss) {
  const Transducer transducer = convex();
  const SceneBox box = box_for(transducer, 120.0);
  constexpr double kThick_mm = 16.0;
  const ScenePtr with = slab_scene(box, TestTissue::kTissue, {15.0, 40.0, 40.0 + kThick_mm, TestTissue::kWater});
  const ScenePtr without = homogeneous_scene(box, TestTissue::kTissue);
  const double expected_db = 2.0 * 3.5 * 0.5 * 0.1 * kThick_mm;
  const double measured_db = behind_against_without_db(with, without, losses(), 0.0, 8.0, 65.0, 100.0);
  EXPECT_NEAR(measured_db, expected_db, 0.3);
  EXPECT_NEAR(behind_against_without_db(with, without, no_artefacts(), 0.0, 8.0, 65.0, 100.0), 0.0, 0.1) << "off";
}

/// Echo of the border at 20 mm and amplitude of the speckle behind it against none, under normal incidence.
struct Balance {
  double echo, passed;
};
Balance balance_of(TestTissue behind) {
  const Transducer transducer = linear();
  const SceneBox box = box_for(transducer, transducer.depth_mm);
  const TestLayer layers[] = {{20.0, TestTissue::kLossless}, {1e9, behind}};
  BMode engine(layers_scene(box, layers), transducer, plain(transducer, losses()));
  BMode without(homogeneous_scene(box, TestTissue::kLossless), transducer, plain(transducer, losses()));
  const BasebandFrame& frame = engine.render({});
  const EchoPatch at_border = patch_at(frame, 0.0, 10.0, 19.0, 21.0);
  Balance balance{};
  for (int line = 0; line < at_border.lines; ++line) {  // mean over scanlines: speckle adds to the border's echo
    float highest = 0.0F;
    for (int s = 0; s < at_border.samples; ++s) highest = std::max(highest, at_border.at(line, s));
    balance.echo += static_cast<double>(highest) / at_border.lines;
  }
  const double behind_rms = root_mean_square(patch_at(frame, 0.0, 10.0, 25.0, 38.0));
  balance.passed = behind_rms / root_mean_square(patch_at(without.render({}), 0.0, 10.0, 25.0, 38.0));
  return balance;
}

TEST(EnergyBalance, ReflectionPlusTransmissionIsTheIncidentEnergy) {
  const double all = balance_of(TestTissue::kGas).echo;  // reflects 0.999 of the amplitude
  for (const auto& [tissue, r] :
       {std::pair{TestTissue::kDense, 1.0 / 11.0}, std::pair{TestTissue::kDenser, 1.0 / 3.0}}) {
    const Balance balance = balance_of(tissue);
    const double reflected = balance.echo / all;
    EXPECT_NEAR(reflected, r, 0.05 * r + 0.003);
    EXPECT_NEAR(balance.passed, 1.0 - r * r, 0.01);
    // Amplitude there and back of what passes is the one-way intensity.
    EXPECT_NEAR(reflected * reflected + balance.passed, 1.0, 0.02);
  }
}

TEST(EnergyBalance, EqualImpedancesTransmitEverything) {
  EXPECT_NEAR(balance_of(TestTissue::kSlow).passed, 1.0, 0.01);
}

/// Mean over scanlines of the highest echo within 3 mm of a plane through (0, 50), dB; and its spread, dB.
struct PlaneEcho {
  double mean_db = 0.0, spread_db = 0.0;
};
PlaneEcho echo_of_plane(double tilt_deg) {
  const Transducer transducer = linear();
  const SceneBox box = box_for(transducer, transducer.depth_mm, 0.5);
  const TestPlane plane{20.0, tilt_deg * std::acos(-1.0) / 180.0, TestTissue::kDenser};
  const ScenePtr scene = with_table(plane_scene(box, TestTissue::kWater, plane), [](AcousticTable& table) {
    table.tissues[index_of(TestTissue::kDenser)].backscatter_db = -80.0;
  });
  BMode engine(scene, transducer, plain(transducer));
  const BasebandFrame& frame = engine.render({});
  std::vector<double> levels;
  for (int line = 64; line < 192; ++line) {
    const double x_mm = frame.geometry.line_origin(line).x();
    const double depth_mm = plane.y_mm - x_mm * std::tan(plane.tilt_rad);
    levels.push_back(
        20.0 *
        std::log10(peak_of(envelope_patch(frame, {line, line + 1, depth_mm - 3.0, depth_mm + 3.0})).amplitude + 1e-3));
  }
  PlaneEcho echo;
  for (const double level : levels) echo.mean_db += level / static_cast<double>(levels.size());
  for (const double level : levels)
    echo.spread_db += std::pow(level - echo.mean_db, 2) / static_cast<double>(levels.size());
  echo.spread_db = std::sqrt(echo.spread_db);
  return echo;
}

TEST(SurfaceEcho, FallsWithTheAngle) {
  const double straight_db = echo_of_plane(0.0).mean_db;
  EXPECT_NEAR(straight_db, 20.0 * std::log10(250.0 / 3.0), 0.5);  // kPerfect of detail/surface_echo, times R
  double last_db = straight_db;
  for (const double tilt_deg : {5.0, 10.0, 15.0, 20.0, 30.0}) {
    const PlaneEcho echo = echo_of_plane(tilt_deg);
    EXPECT_LT(echo.mean_db, last_db) << tilt_deg;
    // Voxels are half a millimetre: the plane is a staircase, and its normal known to some degrees.
    EXPECT_LT(echo.spread_db, tilt_deg < 25.0 ? 3.0 : 5.0) << "a flat border is no row of dashes " << tilt_deg;
    last_db = echo.mean_db;
  }
  EXPECT_LT(last_db, straight_db - 20.0);
}

}  // namespace
}  // namespace trocar::ultrasound
