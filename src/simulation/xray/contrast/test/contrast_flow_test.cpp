#include "xray/contrast/contrast_flow.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/files/folders.h"
#include "duct_patient.h"
#include "volume/sampling.h"

namespace trocar::xray {
namespace {

using testing::ball;
using testing::everywhere;
using testing::make_labelled_patient;
using testing::tube;

constexpr double kIodine = 300.0;
constexpr double kFrame_s = 1.0 / 30.0;

ContrastTable shipped_table() {
  auto table = load_contrast_table(data_dir() / "contrast.toml");
  EXPECT_TRUE(table) << table.error().text();
  return table.value_or(ContrastTable{});
}

ContrastFlow make_flow(std::shared_ptr<const anatomy::VirtualPatient> patient, BloodVelocity blood = {},
                       const ContrastTable& table = shipped_table()) {
  auto flow = ContrastFlow::make(std::move(patient), table, std::move(blood));
  EXPECT_TRUE(flow) << flow.error().text();
  return *std::move(flow);
}

/// Duct, vessel, ascites and bowel in a liver, in muscle; nothing at the sides.
std::shared_ptr<anatomy::VirtualPatient> make_patient() {
  return make_labelled_patient({160, 120, 120}, {2, 2, 2},
                               {{"muscle", "muscle", [](const Vec3& p) { return std::abs(p.x()) < 70; }},
                                {"liver", "liver", [](const Vec3& p) { return std::abs(p.x()) < 40; }},
                                {"ascites", "ascites", [](const Vec3& p) { return p.x() > 40 && p.x() < 60; }},
                                {"bowel", "bowel", [](const Vec3& p) { return p.z() < -50 && p.x() < 40; }},
                                {"vein", "vessel", tube({-20, -40, 20}, {-20, 40, 20}, 5.0)},
                                {"duct", "bile_duct", tube({0, 0, -47}, {0, 0, 40}, 3.0)}});
}

void run(ContrastFlow& flow, double seconds, double dt_s = kFrame_s) {
  const auto steps = static_cast<int>(std::lround(seconds / dt_s));
  for (int n = 0; n < steps; ++n) flow.step(dt_s);
}

double balance_mg(const ContrastTotals& totals) {
  return totals.in_body_mg() + totals.drained_mg + totals.washed_away_mg + totals.spilled_mg;
}

double grid_mg(const Iodine& iodine) {
  double mg = 0.0;
  for (const auto& grid : iodine.grids_mg_per_ml) {
    double sum = 0.0;
    for (const float value : grid->voxels) sum += static_cast<double>(value);
    mg += sum * grid->geometry.voxel_volume_mm3() / 1000.0;
  }
  return mg;
}

/// The one grid of a flow's iodine.
std::shared_ptr<const volume::FloatGrid> only_grid(const ContrastFlow& flow) {
  const Iodine iodine = flow.iodine();
  EXPECT_EQ(iodine.grids_mg_per_ml.size(), 1u);
  return iodine.grids_mg_per_ml.empty() ? std::make_shared<const volume::FloatGrid>() : iodine.grids_mg_per_ml.front();
}

/// Mean of the squared distance from a point along one axis.
double spread_mm2(const volume::FloatGrid& grid, const Vec3& from_P, Eigen::Index axis) {
  double sum = 0.0, second = 0.0;
  for (std::size_t n = 0; n < grid.voxels.size(); ++n) {
    const double away = grid.geometry.centre_mm(grid.geometry.index_of(n))[axis] - from_P[axis];
    sum += static_cast<double>(grid.voxels[n]);
    second += static_cast<double>(grid.voxels[n]) * away * away;
  }
  return second / sum;
}

TEST(ContrastFlow, NamesTheTissueAtTheTip) {
  const ContrastFlow flow = make_flow(make_patient());
  EXPECT_EQ(flow.place({0, 0, 10}), ContrastPlace::kDuct);
  EXPECT_EQ(flow.place({-20, 0, 20}), ContrastPlace::kVessel);
  EXPECT_EQ(flow.place({20, 20, 0}), ContrastPlace::kParenchyma);
  EXPECT_EQ(flow.place({50, 0, 0}), ContrastPlace::kFluid);
  EXPECT_EQ(flow.place({0, 0, -55}), ContrastPlace::kBowel);
  EXPECT_EQ(flow.place({65, 0, 0}), ContrastPlace::kTissue);
  EXPECT_EQ(flow.place({75, 0, 0}), ContrastPlace::kOutside);
  EXPECT_EQ(flow.place({1e9, 0, 0}), ContrastPlace::kOutside);
  EXPECT_EQ(flow.place({std::numeric_limits<double>::quiet_NaN(), 0, 0}), ContrastPlace::kOutside);
}

TEST(ContrastFlow, ConservesIodineWithChangingTips) {
  ContrastFlow flow = make_flow(make_patient(), [](const Vec3&, double) { return Vec3(0, 150, 0); });
  const std::vector<Vec3> tips{{0, 0, 10},   {-20, 0, 20}, {20, 20, 0}, {50, 0, 0},  {0, 0, -55},
                               {65, 10, 10}, {75, 0, 0},   {0, 0, -20}, {39.5, 0, 0}};
  for (int round = 0; round < 36; ++round) {
    const Vec3& tip = tips[static_cast<std::size_t>(round) % tips.size()];
    ASSERT_TRUE(flow.inject(tip, round % 4 == 3 ? 0.0 : 0.5, 200.0 + round));
    run(flow, 0.5, round % 2 == 0 ? 0.02 : 0.1);
    const ContrastTotals totals = flow.totals();
    EXPECT_NEAR(balance_mg(totals), totals.injected_mg, 1e-6 * totals.injected_mg);
  }
  const ContrastTotals totals = flow.totals();
  EXPECT_GT(totals.ducts_mg, 0.0);
  EXPECT_GT(totals.tissue_mg, 0.0);
  EXPECT_GT(totals.washed_away_mg, 0.0);
  EXPECT_GT(totals.drained_mg, 0.0);
  EXPECT_GT(totals.spilled_mg, 0.0);
  // The picture has all of it, to a float's rounding and what is too thin to be shown.
  EXPECT_NEAR(grid_mg(flow.iodine()), totals.tissue_mg, 1e-3 * totals.tissue_mg);
}

TEST(ContrastFlow, DoesNotDependOnTheStep) {
  const std::vector<Vec3> tips{{0, 0, 10}, {-20, 0, 20}, {20, 20, 0}, {50, 0, 0}};
  for (const Vec3& tip : tips) {
    ContrastFlow fine = make_flow(make_patient()), coarse = make_flow(make_patient());
    ASSERT_TRUE(fine.inject(tip, 0.5, kIodine) && coarse.inject(tip, 0.5, kIodine));
    run(fine, 2.0, 0.02);
    run(coarse, 2.0, 0.1);
    const ContrastTotals a = fine.totals(), b = coarse.totals();
    EXPECT_NEAR(a.injected_ml, 1.0, 1e-9);
    EXPECT_NEAR(a.in_body_mg(), b.in_body_mg(), 0.002 * a.injected_mg);
    EXPECT_NEAR(a.drained_mg, b.drained_mg, 0.002 * a.injected_mg);
    EXPECT_EQ(fine.iodine().pieces.size(), coarse.iodine().pieces.size());
  }
}

/// The shipped table, but stains do not fade; with uniform tissue on request.
ContrastTable lasting_table(bool is_uniform = false) {
  ContrastTable table = shipped_table();
  for (ContrastMedium& medium : table.media) {
    medium.fade_s = 0.0;
    if (is_uniform) medium.heterogeneity = 0.0;
  }
  return table;
}

/// Simpson's rule for x^power (1 - exp(1 - 1/x)) over 0..1.
double share_moment(int power) {
  constexpr int kIntervals = 2000;
  double sum = 0.0;
  for (int n = 1; n <= kIntervals; ++n) {
    const double x = static_cast<double>(n) / kIntervals;
    const double weight = n == kIntervals ? 1.0 : n % 2 == 1 ? 4.0 : 2.0;
    sum += weight * std::pow(x, power) * (1.0 - std::exp(1.0 - 1.0 / x));
  }
  return sum / (3.0 * kIntervals);
}

TEST(ContrastFlow, UniformTissueStainFollowsThePressure) {
  const ContrastTable table = lasting_table(true);
  const auto patient = make_labelled_patient({120, 120, 120}, {2, 2, 2}, {{"liver", "liver", everywhere()}});
  ContrastFlow flow = make_flow(patient, {}, table);
  const double space = table.media[table.medium_of("liver")].space;
  const Vec3 tip(3, -2, 1);
  ASSERT_TRUE(flow.inject(tip, 0.5, kIodine));
  for (const double ml : {1.0, 2.0, 4.0}) {
    run(flow, (ml - flow.totals().injected_ml) / 0.5);
    // volume = space 4 pi R³ <x²>, mean of a coordinate's square = R²/3 <x⁴>/<x²>
    const double front_mm = std::cbrt(ml * 1000.0 / (space * 4.0 * std::numbers::pi * share_moment(2)));
    const double expected_mm2 = front_mm * front_mm / 3.0 * share_moment(4) / share_moment(2);
    const auto grid = only_grid(flow);
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(spread_mm2(*grid, tip, axis), expected_mm2, 0.1 * expected_mm2);  // first-order fast marching
    float most = 0.0F;
    for (const float value : grid->voxels) most = std::max(most, value);
    EXPECT_NEAR(static_cast<double>(most), space * kIodine, 0.01 * space * kIodine);
    EXPECT_NEAR(flow.tissue().fluid_ml(), ml, 1e-9);
  }
}

/// Distances from the tip at which the density has fallen to half the greatest, in directions all around.
std::vector<double> half_distances_mm(const volume::FloatGrid& grid, const Vec3& tip_P, double most_mg_per_ml) {
  std::vector<double> distances;
  constexpr int kDirections = 200;
  for (int n = 0; n < kDirections; ++n) {  // a spiral over the sphere
    const double z = 1.0 - (2.0 * n + 1.0) / kDirections, angle = 2.399963 * n;
    const Vec3 out = Vec3(std::cos(angle), std::sin(angle), 0.0) * std::sqrt(1.0 - z * z) + Vec3(0, 0, z);
    double mm = 0.0;
    while (volume::sample_linear(grid, Vec3(tip_P + mm * out)) > 0.5 * most_mg_per_ml) mm += 0.25;
    distances.push_back(mm);
  }
  return distances;
}

double variation(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  for (const double value : values) sum += value, squares += value * value;
  const double mean = sum / static_cast<double>(values.size());
  return std::sqrt(squares / static_cast<double>(values.size()) - mean * mean) / mean;
}

TEST(ContrastFlow, TissueStainIsIrregularAndConservesIodine) {
  const auto patient = make_labelled_patient({120, 120, 120}, {2, 2, 2}, {{"liver", "liver", everywhere()}});
  const Vec3 tip(3, -2, 1);
  std::array<double, 2> found{};
  for (const bool is_uniform : {false, true}) {
    const ContrastTable table = lasting_table(is_uniform);
    ContrastFlow flow = make_flow(patient, {}, table);
    ASSERT_TRUE(flow.inject(tip, 1.0, kIodine));
    double before_mm2 = 0.0;
    for (int n = 0; n < 4; ++n) {
      run(flow, 0.5);
      const ContrastTotals totals = flow.totals();
      EXPECT_NEAR(flow.tissue().fluid_ml(), totals.injected_ml, 1e-9 * totals.injected_ml);
      EXPECT_NEAR(totals.tissue_mg, totals.injected_mg, 1e-9 * totals.injected_mg);
      double spread = 0.0;
      for (Eigen::Index axis = 0; axis < 3; ++axis) spread += spread_mm2(*only_grid(flow), tip, axis);
      EXPECT_GT(spread, 1.1 * before_mm2) << "the second moment grows";
      before_mm2 = spread;
    }
    const double most = table.media[table.medium_of("liver")].space * kIodine;
    found[is_uniform ? 1 : 0] = variation(half_distances_mm(*only_grid(flow), tip, most));
  }
  EXPECT_GT(found[0], 0.15) << "lobes";
  EXPECT_LT(found[1], 0.05) << "a ball";
}

TEST(ContrastFlow, StainReachesFartherAlongAVessel) {
  const auto patient = make_labelled_patient(
      {120, 120, 120}, {1.5, 1.5, 1.5},
      {{"liver", "liver", everywhere()}, {"portal", "vessel", tube({5, -55, 0}, {5, 55, 0}, 3.0)}});
  ContrastFlow flow = make_flow(patient, {}, lasting_table(true));
  ASSERT_TRUE(flow.inject({0, 0, 0}, 1.0, kIodine));
  run(flow, 1.0);
  const auto grid = only_grid(flow);
  EXPECT_GT(spread_mm2(*grid, Vec3::Zero(), 1), 1.15 * spread_mm2(*grid, Vec3::Zero(), 2));
  EXPECT_EQ(flow.totals().vessels_mg, 0.0);
}

TEST(ContrastFlow, BlushFadesWithItsTimeConstant) {
  const ContrastTable table = shipped_table();
  ContrastFlow flow = make_flow(make_patient());
  ASSERT_TRUE(flow.inject({20, 20, 0}, 1.0, kIodine));
  run(flow, 1.0);
  flow.stop_injection();
  const double before = flow.totals().tissue_mg;
  run(flow, 60.0);
  EXPECT_NEAR(flow.totals().tissue_mg / before, std::exp(-60.0 / table.media[table.medium_of("liver")].fade_s), 1e-3);
}

TEST(ContrastFlow, BlushStaysInItsOrgan) {
  const auto patient = make_patient();
  ContrastFlow flow = make_flow(patient);
  ASSERT_TRUE(flow.inject({38, 0, 0}, 2.0, kIodine));  // 2 mm below the capsule
  run(flow, 5.0);
  const ContrastTotals totals = flow.totals();
  EXPECT_GT(totals.tissue_mg, 2000.0);
  EXPECT_NEAR(flow.tissue().iodine_mg_in(patient->label_table.find("liver")->id), totals.tissue_mg, 1e-9);
  EXPECT_EQ(totals.ducts_mg, 0.0);
}

TEST(ContrastFlow, SmallOrganIsLimitedToItsCapacity) {
  ContrastTable table = shipped_table();
  for (ContrastMedium& medium : table.media) medium.fade_s = 0.0;
  const auto patient = make_labelled_patient(
      {80, 80, 80}, {2, 2, 2}, {{"muscle", "muscle", everywhere()}, {"gland", "organ", ball({0, 0, 0}, 10.0)}});
  ContrastFlow flow = make_flow(patient, {}, table);
  ASSERT_TRUE(flow.inject({0, 0, 0}, 1.0, kIodine));
  run(flow, 5.0);
  const double holds_ml = table.media[table.medium_of("organ")].space * 4.0 / 3.0 * std::numbers::pi;
  EXPECT_NEAR(flow.totals().tissue_mg, holds_ml * kIodine, 0.1 * holds_ml * kIodine);  // voxels of 2.5 mm
  EXPECT_GT(flow.totals().washed_away_mg, 3.0 * kIodine);
}

TEST(ContrastFlow, CloudInFluidSpreadsAsDiffusionDoes) {
  const ContrastTable table = shipped_table();
  const auto patient = make_labelled_patient({240, 240, 240}, {4, 4, 4}, {{"ascites", "ascites", everywhere()}});
  ContrastFlow flow = make_flow(patient);
  const Vec3 tip(1, 2, 3);
  ASSERT_TRUE(flow.inject(tip, 2.0, kIodine));
  run(flow, 0.2);
  flow.stop_injection();
  const double mixing = table.media[table.medium_of("ascites")].mixing_mm2_per_s;
  const double before = spread_mm2(*only_grid(flow), tip, 0);
  run(flow, 10.0);
  EXPECT_NEAR(spread_mm2(*only_grid(flow), tip, 0) - before, 2.0 * mixing * 10.0, 0.02 * 2.0 * mixing * 10.0);
  EXPECT_NEAR(flow.totals().tissue_mg, flow.totals().injected_mg, 1e-9 * flow.totals().injected_mg);
}

TEST(ContrastFlow, BloodCarriesAStreakAwayAlongTheVessel) {
  ContrastFlow flow = make_flow(make_patient(), [](const Vec3&, double) { return Vec3(0, 100, 0); });
  ASSERT_TRUE(flow.inject({-20, -20, 20}, 1.0, kIodine));
  run(flow, 0.3);
  const Iodine iodine = flow.iodine();
  ASSERT_FALSE(iodine.pieces.empty());
  double farthest = -1e9, nearest = 1e9;
  for (const IodinePiece& piece : iodine.pieces) {
    farthest = std::max(farthest, piece.b_P.y());
    nearest = std::min(nearest, piece.a_P.y());
    EXPECT_LE(piece.iodine_mg_per_ml, 1.02 * kIodine);  // steps of 1 mm
    EXPECT_LE(piece.radius_a_mm, 6.5);                  // the vein, to a voxel
  }
  // The injected volume adds to the flow. Where the stream is thinner than 1.7 mm, it moves by its own volume: the time
  // to there is the volume of this cone at 1000 mm³/s.
  const double flow_mm_per_s = 100.0 + 1000.0 / (std::numbers::pi * 25.0);
  const double thin_mm = std::sqrt(1000.0 / (std::numbers::pi * flow_mm_per_s)), start_mm = 0.35, slope = 0.2;
  const double cone_s = std::numbers::pi / (3.0 * slope) * (std::pow(thin_mm, 3) - std::pow(start_mm, 3)) / 1000.0;
  const double front_mm = (thin_mm - start_mm) / slope + (0.3 - cone_s) * flow_mm_per_s;
  EXPECT_NEAR(farthest, -20.0 + front_mm, 3.0);  // voxels of 2 mm, steps of 1 mm
  EXPECT_NEAR(nearest, -20.0, 2.0);
  run(flow, 2.0);
  flow.stop_injection();
  const double injected = flow.totals().injected_mg;
  EXPECT_LT(flow.totals().vessels_mg, 0.2 * injected);
  run(flow, 1.3);
  EXPECT_EQ(flow.totals().vessels_mg, 0.0);
  EXPECT_TRUE(flow.iodine().pieces.empty());
  EXPECT_NEAR(flow.totals().washed_away_mg, injected, 1e-9 * injected);
}

/// Iodine of the pieces with their middle at y within [low, high).
double pieces_mg(const std::vector<IodinePiece>& pieces, double low = -1e9, double high = 1e9) {
  double mg = 0.0;
  for (const IodinePiece& piece : pieces) {
    const double y = 0.5 * (piece.a_P.y() + piece.b_P.y()), a = piece.radius_a_mm, b = piece.radius_b_mm;
    if (y < low || y >= high) continue;
    mg += std::numbers::pi / 3.0 * (a * a + a * b + b * b) * (piece.b_P - piece.a_P).norm() / 1000.0 *
          piece.iodine_mg_per_ml;
  }
  return mg;
}

/// Laminar flow in the vein of make_patient, 200 mm/s in its middle.
Vec3 laminar(const Vec3& p_P, double) {
  const double square = (p_P - Vec3(-20.0, p_P.y(), 20.0)).squaredNorm() / 25.0;
  return {0.0, 200.0 * std::max(1.0 - square, 0.0), 0.0};
}

TEST(ContrastFlow, StreakWidensToTheWallsAndStaysInside) {
  const auto patient = make_patient();
  ContrastFlow flow = make_flow(patient, laminar);
  const Vec3 tip(-18, -30, 19);
  ASSERT_TRUE(flow.inject(tip, 1.0, kIodine));
  run(flow, 0.6);
  const Iodine iodine = flow.iodine();
  ASSERT_FALSE(iodine.pieces.empty());
  EXPECT_NEAR(pieces_mg(iodine.pieces), flow.totals().vessels_mg, 0.002 * flow.totals().vessels_mg);
  double widest_mm = 0.0;
  for (const IodinePiece& piece : iodine.pieces) {
    const Vec3 along = (piece.b_P - piece.a_P).normalized();
    const Vec3 u = along.unitOrthogonal(), w = along.cross(u);
    for (int n = 0; n < 12; ++n) {
      const double angle = n * std::numbers::pi / 6.0;
      const Vec3 rim_P = piece.b_P + piece.radius_b_mm * (std::cos(angle) * u + std::sin(angle) * w);
      const Vec3 across(rim_P.x() + 20.0, 0.0, rim_P.z() - 20.0);
      EXPECT_LE(across.norm(), 5.0 + 1.0) << "half a voxel outside of the vein";
      if (piece.b_P.y() > -5.0) widest_mm = std::max(widest_mm, across.norm());
      if (piece.b_P.y() < tip.y() + 10.0) {
        // Fanning by a fifth of the way, about a line that moves to the middle by a third of it.
        EXPECT_LE((rim_P - tip - Vec3(0, rim_P.y() - tip.y(), 0)).norm(),
                  1.0 + 0.7 * std::abs(piece.b_P.y() - tip.y()));
      }
    }
  }
  EXPECT_GT(widest_mm, 0.75 * 5.0) << "it reaches the walls 25 mm down the flow";
}

TEST(ContrastFlow, StreakWashesOutGraduallyInLaminarFlow) {
  /// Length over which the iodine per length rises from a tenth to nine tenths, behind the tail.
  const auto tail_mm = [](const BloodVelocity& blood) {
    ContrastFlow flow = make_flow(make_patient(), blood);
    EXPECT_TRUE(flow.inject({-20, -38, 20}, 2.0, kIodine));
    run(flow, 0.4, 0.02);
    flow.stop_injection();
    run(flow, 0.2, 0.02);
    const std::vector<IodinePiece> pieces = flow.iodine().pieces;
    double most = 0.0;
    for (double y = -44.0; y < 40.0; y += 2.0) most = std::max(most, pieces_mg(pieces, y, y + 2.0));
    double from = 40.0, to = 40.0;
    for (double y = 36.0; y >= -44.0; y -= 2.0) {
      const double mg = pieces_mg(pieces, y, y + 2.0);
      if (mg > 0.1 * most) from = y;
      if (mg > 0.9 * most) to = y;
    }
    return to - from;
  };
  EXPECT_GE(tail_mm(laminar), 10.0) << "a diameter or more";
  EXPECT_LE(tail_mm([](const Vec3&, double) { return Vec3(0, 150, 0); }), 8.0) << "a plug";
}

TEST(ContrastFlow, VesselFadesWithoutBloodFlow) {
  ContrastFlow flow = make_flow(make_patient());
  ASSERT_TRUE(flow.inject({-20, 0, 20}, 1.0, kIodine));
  run(flow, 1.0);
  EXPECT_FALSE(flow.iodine().pieces.empty());
  flow.stop_injection();
  run(flow, 1.5);
  EXPECT_EQ(flow.totals().vessels_mg, 0.0);
}

TEST(ContrastFlow, InjectionOutsideTheBodyIsSpilled) {
  ContrastFlow flow = make_flow(make_patient());
  ASSERT_TRUE(flow.inject({500, 0, 0}, 5.0, kIodine));
  run(flow, 1.0);
  EXPECT_TRUE(flow.iodine().pieces.empty());
  EXPECT_TRUE(flow.iodine().grids_mg_per_ml.empty());
  EXPECT_NEAR(flow.totals().spilled_mg, 5.0 * kIodine, 1e-6);
}

TEST(ContrastFlow, DepotInMuscleStays) {
  ContrastFlow flow = make_flow(make_patient());
  ASSERT_TRUE(flow.inject({65, 0, 0}, 0.5, kIodine));
  run(flow, 1.0);
  flow.stop_injection();
  run(flow, 60.0);
  EXPECT_NEAR(flow.totals().tissue_mg, 0.5 * kIodine, 1e-6);
}

TEST(ContrastFlow, RefusesImpossibleInjectionsAndStops) {
  ContrastFlow flow = make_flow(make_patient());
  const double nan = std::numeric_limits<double>::quiet_NaN(), huge = std::numeric_limits<double>::infinity();
  ASSERT_TRUE(flow.inject({0, 0, 10}, 1.0, kIodine));
  for (const auto& refused :
       {flow.inject({nan, 0, 0}, 1.0, kIodine), flow.inject({0, huge, 0}, 1.0, kIodine),
        flow.inject({0, 0, 10}, -1.0, kIodine), flow.inject({0, 0, 10}, 1e9, kIodine),
        flow.inject({0, 0, 10}, nan, kIodine), flow.inject({0, 0, 10}, 1.0, -5.0), flow.inject({0, 0, 10}, 1.0, nan)}) {
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().exit_status, 2);
    EXPECT_FALSE(refused.error().advice.empty());
  }
  run(flow, 1.0);
  EXPECT_EQ(flow.totals().injected_mg, 0.0);
}

TEST(ContrastFlow, NeedsLabels) {
  const auto flow = ContrastFlow::make(std::make_shared<anatomy::VirtualPatient>(), shipped_table());
  ASSERT_FALSE(flow);
  EXPECT_NE(flow.error().text().find("labels"), std::string::npos);
}

TEST(ContrastTable, TreatsUnlistedTissuesAsOther) {
  const ContrastTable table = shipped_table();
  ASSERT_GE(table.media.size(), 2u);
  EXPECT_EQ(table.media[table.medium_of("muscle")].place, ContrastPlace::kTissue);
  EXPECT_EQ(table.media[table.medium_of("liver")].place, ContrastPlace::kParenchyma);
  EXPECT_EQ(table.media[table.medium_of("ascites")].place, ContrastPlace::kFluid);
}

}  // namespace
}  // namespace trocar::xray
