#include "haptics/proxy/needle_beam.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.h"
#include "core/testing/allocation_guard.h"

namespace trocar::testing {
namespace {

constexpr double kBeam_mm = 150.0;
constexpr double kStiffness_n_mm2 = 2600.0;  // About 22 G.
constexpr double kRounding = 1e-10;          // Relative; the passes add positive numbers only.

haptics::NeedleBeam beam_of(int nodes) {
  return {nodes, kBeam_mm / nodes, kStiffness_n_mm2};
}
double arc_mm(const haptics::NeedleBeam& beam, int node) {
  return beam.spacing_mm * (node + 1);
}
std::size_t at(int node) {
  return static_cast<std::size_t>(node);
}

/// Deflection at x of a cantilever with a unit force at a.
double cantilever_mm_per_n(double x, double a) {
  const double near = std::min(x, a);
  return near * near * (3.0 * std::max(x, a) - near) / (6.0 * kStiffness_n_mm2);
}

/// The same bed by the cantilever's influence numbers and a dense solver: independent of the spans.
Eigen::MatrixXd dense_deflections(const haptics::NeedleBeam& beam, const haptics::BeamBed& bed, bool has_tip_force) {
  const int n = beam.node_count;
  Eigen::MatrixXd compliance(n, n), forces(n, 3);
  Eigen::VectorXd k(n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) compliance(i, j) = cantilever_mm_per_n(arc_mm(beam, i), arc_mm(beam, j));
    k(i) = bed.stiffness_n_per_mm[at(i)];
    forces.row(i) = (has_tip_force ? 0.0 : k(i)) * bed.offset_mm[at(i)].transpose();
  }
  if (has_tip_force) forces(n - 1, 0) = 1.0;
  const Eigen::MatrixXd system = Eigen::MatrixXd::Identity(n, n) + compliance * k.asDiagonal();
  return system.fullPivLu().solve(compliance * forces);
}

TEST(NeedleBeam, BendsUnderATipForceAsACantilever) {
  for (const int nodes : {2, 17, 33}) {
    const haptics::NeedleBeam beam = beam_of(nodes);
    const haptics::BeamSolution solution = haptics::solve_beam(beam, {});
    for (int i = 0; i < nodes; ++i) {
      const double expected = cantilever_mm_per_n(arc_mm(beam, i), kBeam_mm);
      EXPECT_NEAR(solution.per_tip_force_mm_n[at(i)], expected, kRounding * expected);
      EXPECT_EQ(solution.deflection_mm[at(i)].norm(), 0.0);
    }
    const double tip = kBeam_mm * kBeam_mm * kBeam_mm / (3.0 * kStiffness_n_mm2);  // F L^3 / 3 E I
    EXPECT_NEAR(solution.per_tip_force_mm_n[at(nodes - 1)], tip, kRounding * tip);
    EXPECT_FALSE(solution.is_bound);
  }
}

TEST(NeedleBeam, SharesItsLoadWithOneSpring) {
  const haptics::NeedleBeam beam = beam_of(17);
  const Vec3 offset(1.5, -0.5, 0.25);
  for (const int node : {0, 7, 16}) {
    for (const double k : {0.001, 0.5, 1e4}) {
      haptics::BeamBed bed;
      bed.stiffness_n_per_mm[at(node)] = k;
      bed.offset_mm[at(node)] = offset;
      const double a = arc_mm(beam, node);
      const double own = 3.0 * kStiffness_n_mm2 / (a * a * a);
      const Vec3 expected = offset * (k / (k + own));  // Springs in series.
      const haptics::BeamSolution solution = haptics::solve_beam(beam, bed);
      EXPECT_NEAR((solution.deflection_mm[at(node)] - expected).norm(), 0.0, kRounding * expected.norm());
    }
  }
}

TEST(NeedleBeam, IsSupportedByAStiffSpring) {
  // Force F at the tip, a support at a: the support bears R = F (3 L - a) / (2 a), the tip's own formula less its.
  const haptics::NeedleBeam beam = beam_of(15);
  const int support = 9;
  const double a = arc_mm(beam, support);
  haptics::BeamBed bed;
  bed.stiffness_n_per_mm[at(support)] = 1e9;  // Gives by 1e-9 mm: the tolerance.
  const haptics::BeamSolution solution = haptics::solve_beam(beam, bed);
  const double reaction = (3.0 * kBeam_mm - a) / (2.0 * a);
  const double tip = cantilever_mm_per_n(kBeam_mm, kBeam_mm) - reaction * cantilever_mm_per_n(kBeam_mm, a);
  EXPECT_NEAR(solution.per_tip_force_mm_n[at(14)], tip, 1e-7 * tip);
  EXPECT_NEAR(solution.per_tip_force_mm_n[at(support)], 0.0, 1e-8);
}

TEST(NeedleBeam, MatchesHetenyisElasticFoundation) {
  // Half-infinite bed of k N/mm^2 from the clamp on, force at the far, free end: w = 2 F b / k, b = (k / 4 E I)^(1/4).
  // b L = 12 leaves exp(-12) of the clamp. Springs at nodes are the trapezoidal rule of a bed: at its end they differ
  // by terms of (b h)^2, which must fall as the square of the spacing.
  const double b = 12.0 / kBeam_mm;
  const double k = 4.0 * kStiffness_n_mm2 * std::pow(b, 4.0);
  double previous = 0.0;
  for (const int nodes : {17, 25, 33}) {
    const haptics::NeedleBeam beam = beam_of(nodes);
    haptics::BeamBed bed;
    for (int i = 0; i < nodes; ++i) bed.stiffness_n_per_mm[at(i)] = k * beam.spacing_mm * (i == nodes - 1 ? 0.5 : 1.0);
    const double error = haptics::solve_beam(beam, bed).per_tip_force_mm_n[at(nodes - 1)] * k / (2.0 * b) - 1.0;
    const double order = error / std::pow(b * beam.spacing_mm, 2.0);
    EXPECT_LT(std::abs(order), 1.0 / 3.0);
    if (previous != 0.0) {
      EXPECT_NEAR(order, previous, 0.1 * std::abs(previous));
    }
    previous = order;
  }
}

TEST(NeedleBeam, AgreesWithADenseSolverInRandomBeds) {
  Random random(7);
  for (int trial = 0; trial < 200; ++trial) {
    const haptics::NeedleBeam beam = beam_of(2 + trial % 32);
    haptics::BeamBed bed;
    for (int i = 0; i < beam.node_count; ++i) {
      if (random.uniform(0, 1) < 0.3) continue;
      bed.stiffness_n_per_mm[at(i)] = std::pow(10.0, random.uniform(-4, 0.5));
      bed.offset_mm[at(i)] = 3.0 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    }
    const haptics::BeamSolution solution = haptics::solve_beam(beam, bed);
    if (solution.is_bound) continue;
    const Eigen::MatrixXd free = dense_deflections(beam, bed, false);
    const Eigen::MatrixXd tip = dense_deflections(beam, bed, true);
    constexpr double kDense_mm = 1e-8;  // The dense system is the badly conditioned one.
    for (int i = 0; i < beam.node_count; ++i) {
      EXPECT_NEAR((solution.deflection_mm[at(i)].transpose() - free.row(i)).norm(), 0.0, kDense_mm);
      EXPECT_NEAR(solution.per_tip_force_mm_n[at(i)], tip(i, 0), kDense_mm * (1.0 + tip(beam.node_count - 1, 0)));
    }
  }
}

TEST(NeedleBeam, ObeysBettisReciprocity) {
  // Betti: the work of one load on the other's deflection is the same both ways.
  const haptics::NeedleBeam beam = beam_of(17);
  haptics::BeamBed bed;
  for (int i = 5; i < 17; ++i) bed.stiffness_n_per_mm[at(i)] = 0.02 * i;
  for (int p = 5; p < 17; ++p) {
    haptics::BeamBed shifted = bed;
    shifted.offset_mm[at(p)] = Vec3::UnitX();
    const double tip_by_p = haptics::solve_beam(beam, shifted).deflection_mm[16].x() / bed.stiffness_n_per_mm[at(p)];
    const double p_by_tip = haptics::solve_beam(beam, bed).per_tip_force_mm_n[at(p)];
    EXPECT_NEAR(tip_by_p, p_by_tip, 1e-10);
  }
}

TEST(NeedleBeam, ComputesTheStiffnessAtTheGrip) {
  // Against the supports of a shifted and of a turned grip; a rigid shaft adds up its springs.
  Random random(11);
  for (int trial = 0; trial < 50; ++trial) {
    const haptics::NeedleBeam beam = beam_of(2 + trial % 32);
    haptics::BeamBed shifted, turned;
    double sum = 0.0, sum_turning = 0.0;
    for (int i = 0; i < beam.node_count; ++i) {
      const double k = std::pow(10.0, random.uniform(-4, 0));
      shifted.stiffness_n_per_mm[at(i)] = turned.stiffness_n_per_mm[at(i)] = k;
      shifted.offset_mm[at(i)] = Vec3::UnitX();
      turned.offset_mm[at(i)] = arc_mm(beam, i) / kBeam_mm * Vec3::UnitX();
      sum += k;
      sum_turning += k * arc_mm(beam, i) * arc_mm(beam, i);
    }
    double across = 0.0, turning = 0.0;
    const haptics::BeamSolution shift = haptics::solve_beam(beam, shifted);
    const haptics::BeamSolution turn = haptics::solve_beam(beam, turned);
    for (int i = 0; i < beam.node_count; ++i) {
      const double k = shifted.stiffness_n_per_mm[at(i)];
      across += k * (1.0 - shift.deflection_mm[at(i)].x());
      turning += k * arc_mm(beam, i) * (arc_mm(beam, i) - kBeam_mm * turn.deflection_mm[at(i)].x());
    }
    const haptics::GripStiffness grip = haptics::grip_stiffness(beam, shifted);
    constexpr double kCancelling = 1e-7;  // Relative: supports are small differences of offset and deflection.
    EXPECT_NEAR(grip.across_n_per_mm, across, kCancelling * sum);
    EXPECT_NEAR(grip.turning_nmm_per_rad, turning, kCancelling * sum_turning);
    EXPECT_NEAR(haptics::solve_beam(beam, shifted).turning_nmm_per_rad, turning, kCancelling * sum_turning);
    haptics::NeedleBeam rigid = beam;
    rigid.bending_stiffness_n_mm2 = std::numeric_limits<double>::infinity();
    EXPECT_NEAR(haptics::grip_stiffness(rigid, shifted).across_n_per_mm, sum, kRounding * sum);
    EXPECT_NEAR(haptics::grip_stiffness(rigid, shifted).turning_nmm_per_rad, sum_turning, kRounding * sum_turning);
  }
}

TEST(NeedleBeam, DerivesStiffnessFromTubeAndStylet) {
  haptics::NeedleGeometry needle;
  needle.radius_mm = 0.359;  // 22 G
  needle.young_gpa = 200.0;
  const double solid = haptics::bending_stiffness_n_mm2(needle, true);
  EXPECT_NEAR(solid, 200e3 * std::numbers::pi * std::pow(0.718, 4.0) / 64.0, 1e-9 * solid);
  needle.inner_radius_mm = needle.stylet_radius_mm = 0.2;
  EXPECT_NEAR(haptics::bending_stiffness_n_mm2(needle, true), solid, 1e-9 * solid);
  EXPECT_NEAR(haptics::bending_stiffness_n_mm2(needle, false), solid * (1.0 - std::pow(0.2 / 0.359, 4.0)),
              1e-9 * solid);
}

TEST(NeedleBeam, LimitsItsDeflectionAndFlagsIt) {
  const haptics::NeedleBeam beam = beam_of(17);
  haptics::BeamBed bed;
  bed.stiffness_n_per_mm[16] = 1.0;
  for (const double huge : {400.0, 1e12, 1e200}) {
    bed.offset_mm[16] = huge * Vec3::UnitY();
    const haptics::BeamSolution solution = haptics::solve_beam(beam, bed);
    EXPECT_TRUE(solution.is_bound);
    EXPECT_NEAR(solution.deflection_mm[16].norm(), haptics::kMaxDeflection * kBeam_mm, 1e-6);
  }
}

TEST(NeedleBeam, StaysFiniteForNonFiniteInput) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity, -1.0, 0.0, 1e300}) {
    haptics::BeamBed stiff, off;
    stiff.stiffness_n_per_mm.fill(bad);
    stiff.offset_mm.fill(Vec3::UnitX());
    off.stiffness_n_per_mm.fill(0.1);
    off.offset_mm.fill(Vec3(bad, 0.0, 0.0));
    for (const haptics::BeamBed& bed : {stiff, off}) {
      for (const int nodes : {-5, 0, 1, 17, 1000}) {
        const haptics::BeamSolution solution = haptics::solve_beam({nodes, 8.8, kStiffness_n_mm2}, bed);
        EXPECT_TRUE(std::isfinite(haptics::grip_stiffness({nodes, 8.8, kStiffness_n_mm2}, bed).turning_nmm_per_rad))
            << bad;
        for (int i = 0; i < solution.node_count; ++i) {
          EXPECT_TRUE(solution.deflection_mm[at(i)].allFinite()) << bad << " " << nodes;
          EXPECT_TRUE(std::isfinite(solution.per_tip_force_mm_n[at(i)])) << bad << " " << nodes;
        }
      }
    }
  }
}

TEST(NeedleBeam, NeverAllocates) {
  haptics::BeamBed bed;
  bed.stiffness_n_per_mm.fill(0.1);
  bed.offset_mm.fill(Vec3::UnitX());
  const AllocationGuard guard;
  const haptics::BeamSolution solution = haptics::solve_beam(beam_of(33), bed);
  const haptics::GripStiffness grip = haptics::grip_stiffness(beam_of(33), bed);
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_GT(solution.deflection_mm[32].x() * grip.across_n_per_mm, 0.0);
}

}  // namespace
}  // namespace trocar::testing
