#include "xray/contrast/duct_fill.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace trocar::xray {
namespace {

constexpr double kStep_s = 0.005;
constexpr double kAgent_mg_per_ml = 300.0;

/// Appends a straight duct in pieces; returns the index of its last cell.
int append(DuctTree& tree, int parent, const Vec3& a, const Vec3& b, double radius_mm, int pieces) {
  for (int n = 0; n < pieces; ++n) {
    DuctCell cell;
    cell.a_P = a + (b - a) * n / pieces;
    cell.b_P = a + (b - a) * (n + 1) / pieces;
    cell.radius_a_mm = cell.radius_b_mm = radius_mm;
    cell.parent = n == 0 ? parent : static_cast<int>(tree.cells.size()) - 1;
    tree.cells.push_back(cell);
  }
  return static_cast<int>(tree.cells.size()) - 1;
}

double tube_ml(double radius_mm, double length_mm) {
  return std::numbers::pi * radius_mm * radius_mm * length_mm / 1000.0;
}

/// A stem and two branches of different radius and length; the root is the stem's end.
struct Y {
  DuctTree tree;
  int stem_end = append(tree, -1, {0, 0, -40}, {0, 0, 0}, 3.0, 40);
  int wide_end = append(tree, stem_end, {0, 0, 0}, {30, 0, 30}, 2.5, 40);
  int thin_end = append(tree, stem_end, {0, 0, 0}, {-60, 0, 60}, 1.5, 80);
  double stem_ml = tube_ml(3.0, 40);
  double wide_ml = tube_ml(2.5, 30 * std::numbers::sqrt2);
  double thin_ml = tube_ml(1.5, 60 * std::numbers::sqrt2);
};

DuctParams without_mixing() {
  DuctParams params;
  params.dispersivity_mm = 0.0;
  params.mixing_mm2_per_s = 0.0;
  return params;
}

void inject(DuctFill& fill, int cell, double ml_per_s, double seconds) {
  const auto steps = static_cast<int>(std::lround(seconds / kStep_s));
  for (int n = 0; n < steps; ++n) fill.step(kStep_s, cell, ml_per_s, kAgent_mg_per_ml);
}

/// Contrast agent in the cells [first, last].
double contrast_ml(const DuctFill& fill, int first, int last) {
  double ml = 0.0;
  for (int n = first; n <= last; ++n) {
    const auto cell = static_cast<std::size_t>(n);
    ml += fill.filling(cell) * fill.tree().cells[cell].volume_ml();
  }
  return ml;
}

double filling_at(const DuctFill& fill, double place) {
  return fill.filling(static_cast<std::size_t>(place));
}

TEST(DuctFill, FrontMovesByTheInjectedVolume) {
  DuctTree tree;
  append(tree, -1, {0, 0, 0}, {0, 0, 100}, 2.0, 200);
  DuctFill fill(tree, without_mixing());
  inject(fill, 0, 0.2, 3.0);
  EXPECT_NEAR(fill.contrast_ml(), 0.6, 1e-9);
  EXPECT_NEAR(fill.displaced_ml(), 0.6, 1e-9);
  const double front_mm = 1000.0 * 0.6 / (std::numbers::pi * 4.0);
  EXPECT_GT(filling_at(fill, 2 * (front_mm - 15.0)), 0.99);  // half a cell and half a step blur the front
  EXPECT_NEAR(filling_at(fill, 2 * front_mm), 0.5, 0.1);
  EXPECT_LT(filling_at(fill, 2 * (front_mm + 15.0)), 0.01);
}

TEST(DuctFill, FillsBothBranchesOfAYTogether) {
  const Y y;
  DuctFill fill(y.tree, without_mixing());
  const double rate = 0.1;
  inject(fill, 0, rate, 0.5 * y.stem_ml / rate);  // into the stem
  EXPECT_LT(contrast_ml(fill, y.stem_end + 1, y.thin_end), 0.01 * y.stem_ml);
  inject(fill, 0, rate, (0.5 * y.stem_ml + 0.5 * (y.wide_ml + y.thin_ml)) / rate);
  // Each branch has taken half of its volume: the wide one 0.42 ml, the thin one 0.3 ml.
  EXPECT_NEAR(contrast_ml(fill, y.stem_end + 1, y.wide_end), 0.5 * y.wide_ml, 0.03 * y.wide_ml);
  EXPECT_NEAR(contrast_ml(fill, y.wide_end + 1, y.thin_end), 0.5 * y.thin_ml, 0.03 * y.thin_ml);
  EXPECT_LT(filling_at(fill, y.wide_end), 0.05);
  EXPECT_LT(filling_at(fill, y.thin_end), 0.05);
}

TEST(DuctFill, FlowsBothWaysFromATipInTheMiddle) {
  const Y y;
  DuctFill fill(y.tree, without_mixing());
  const int tip = y.stem_end + 30;  // three quarters along the wide branch
  inject(fill, tip, 0.05, 2.0);
  const double injected = 0.1, total = y.stem_ml + y.wide_ml + y.thin_ml;
  // The flow splits by the bile on both sides; the tip's own cell is a fortieth of the branch.
  const double cell_ml = y.wide_ml / 40.0;
  const double beyond = injected * 0.25 * y.wide_ml / total;
  EXPECT_NEAR(contrast_ml(fill, tip + 1, y.wide_end), beyond, cell_ml);
  EXPECT_GT(contrast_ml(fill, tip + 1, y.wide_end), 0.4 * beyond);
  EXPECT_NEAR(fill.contrast_ml(), injected, 1e-9);
}

TEST(DuctFill, StaysOnItsSideOfAnObstruction) {
  Y y;
  y.tree.cells[static_cast<std::size_t>(y.wide_end + 1)].is_closed = true;  // the thin branch
  DuctFill fill(y.tree, DuctParams{});
  EXPECT_NEAR(fill.reachable_ml(0), y.stem_ml + y.wide_ml, 1e-9);
  EXPECT_NEAR(fill.reachable_ml(static_cast<std::size_t>(y.thin_end)), y.thin_ml, 1e-9);
  inject(fill, 0, 0.5, 20.0);
  EXPECT_EQ(contrast_ml(fill, y.wide_end + 1, y.thin_end), 0.0);
  EXPECT_NEAR(fill.contrast_ml(), fill.reachable_ml(0), 0.01 * y.stem_ml);
}

TEST(DuctFill, DistendsAFullTreeThenLosesTheRest) {
  const Y y;
  const DuctParams params;
  DuctFill fill(y.tree, params);
  const double rest_ml = y.tree.volume_ml();
  inject(fill, 0, 0.2, 3.0 * rest_ml / 0.2);
  EXPECT_NEAR(fill.volume_ml(), rest_ml * (1.0 + params.distension), 1e-6);
  EXPECT_NEAR(fill.contrast_ml(), fill.volume_ml(), 1e-3);
  const double injected_mg =
      static_cast<double>(std::lround(3.0 * rest_ml / 0.2 / kStep_s)) * kStep_s * 0.2 * kAgent_mg_per_ml;
  EXPECT_NEAR(fill.iodine_mg() + fill.refluxed_mg(), injected_mg, 1e-9 * injected_mg);
  EXPECT_GT(fill.refluxed_mg(), 0.5 * injected_mg);
}

TEST(DuctFill, DrainsThroughThePapillaWithItsTimeConstant) {
  DuctTree tree;
  append(tree, -1, {0, 0, 0}, {0, 0, 50}, 2.0, 50);
  tree.cells.front().root_end = DuctEnd::kPapilla;
  DuctParams params;
  params.drain_s = 100.0;
  DuctFill fill(tree, params);
  inject(fill, 49, 0.5, 20.0);
  const double before = fill.contrast_ml();
  ASSERT_GT(before, 0.97 * tree.volume_ml());
  inject(fill, -1, 0.0, 50.0);
  // Bile that is secreted evenly keeps an even filling even: it falls as exp(-t/τ).
  EXPECT_NEAR(fill.contrast_ml() / before, std::exp(-0.5), 0.01);
  EXPECT_GT(fill.drained_mg(), 0.0);
}

TEST(DuctFill, MixesAtRestAsDiffusionDoes) {
  DuctTree tree;
  append(tree, -1, {0, 0, 0}, {0, 0, 200}, 2.0, 400);
  DuctParams params = without_mixing();
  params.mixing_mm2_per_s = 2.0;
  DuctFill fill(tree, params);
  inject(fill, 200, 0.02, 0.5);  // 0.8 mm
  const auto variance = [&] {
    double sum = 0.0, first = 0.0, second = 0.0;
    for (std::size_t n = 0; n < tree.cells.size(); ++n) {
      const double x = 0.5 * static_cast<double>(n), weight = fill.filling(n);
      sum += weight;
      first += weight * x;
      second += weight * x * x;
    }
    return second / sum - first * first / (sum * sum);
  };
  const double before = variance();
  inject(fill, -1, 0.0, 30.0);
  EXPECT_NEAR(variance() - before, 2.0 * 2.0 * 30.0, 0.01 * 120.0);
}

TEST(DuctFill, ConservesIodineOverALongChangingRun) {
  Y y;
  y.tree.cells.front().root_end = DuctEnd::kPapilla;
  DuctFill fill(y.tree, DuctParams{});
  double injected_mg = 0.0;
  for (int n = 0; n < 20000; ++n) {
    const int cell = (n * 7919) % static_cast<int>(y.tree.cells.size());
    const double rate = n / 500 % 3 == 0 ? 0.4 : 0.0;
    const double iodine = 100.0 + n % 7 * 40.0;
    fill.step(kStep_s, cell, rate, iodine);
    injected_mg += kStep_s * rate * iodine;
  }
  EXPECT_NEAR(fill.iodine_mg() + fill.drained_mg() + fill.refluxed_mg(), injected_mg, 1e-9 * injected_mg);
  for (std::size_t n = 0; n < y.tree.cells.size(); ++n) {
    EXPECT_GE(fill.filling(n), -1e-12);
    EXPECT_LE(fill.filling(n), 1.0 + 1e-9);
    EXPECT_LE(fill.iodine_mg_per_ml(n), 340.0 + 1e-6);
  }
}

TEST(DuctFill, PiecesHaveTheMassOfTheTree) {
  const Y y;
  DuctFill fill(y.tree, DuctParams{});
  inject(fill, 10, 0.2, 20.0);  // distended
  std::vector<IodinePiece> pieces;
  fill.add_pieces(0.0, pieces);
  double mg = 0.0;
  for (const IodinePiece& piece : pieces) {
    const double a = piece.radius_a_mm, b = piece.radius_b_mm;
    mg += std::numbers::pi / 3.0 * (a * a + a * b + b * b) * (piece.b_P - piece.a_P).norm() / 1000.0 *
          piece.iodine_mg_per_ml;
  }
  EXPECT_NEAR(mg, fill.iodine_mg(), 1e-9 * mg);
}

/// A closed tube of radius 7 mm along z, 120 mm long, in cells of 1.5 mm.
DuctTree wide_duct() {
  DuctTree tree;
  append(tree, -1, {0, 0, 0}, {0, 0, 120}, 7.0, 80);
  tree.cells.front().root_end = tree.cells.back().end = DuctEnd::kPeripheral;
  return tree;
}

double piece_ml(const IodinePiece& piece) {
  const double a = piece.radius_a_mm, b = piece.radius_b_mm;
  return std::numbers::pi / 3.0 * (a * a + a * b + b * b) * (piece.b_P - piece.a_P).norm() / 1000.0;
}

/// Of the pieces with their middle in [z, z + 3): iodine per length (mg/mm) and the mean radius, weighted by iodine.
struct Slab {
  double mg_per_mm = 0.0, radius_mm = 0.0;
};
Slab slab_at(const std::vector<IodinePiece>& pieces, double z) {
  double mg = 0.0, radius = 0.0;
  for (const IodinePiece& piece : pieces) {
    const double middle = 0.5 * (piece.a_P.z() + piece.b_P.z());
    if (middle < z || middle >= z + 3.0) continue;
    const double part_mg = piece_ml(piece) * piece.iodine_mg_per_ml;
    mg += part_mg;
    radius += part_mg * 0.5 * (piece.radius_a_mm + piece.radius_b_mm);
  }
  return {mg / 3.0, mg > 0.0 ? radius / mg : 0.0};
}

TEST(DuctFill, WideDuctFrontSpansOneToTwoDiameters) {
  DuctFill fill(wide_duct(), DuctParams{});
  inject(fill, 0, 1.0, 5.0);
  std::vector<IodinePiece> pieces;
  fill.add_pieces(0.05, pieces);
  const double full = slab_at(pieces, 15.0).mg_per_mm;
  double at_90 = 0.0, at_10 = 0.0;
  for (double z = 15.0; z < 117.0; z += 3.0) {
    const double mg_per_mm = slab_at(pieces, z).mg_per_mm;
    EXPECT_GE(slab_at(pieces, z - 3.0).mg_per_mm, mg_per_mm - 1e-9 * full) << "at " << z << " mm";
    if (mg_per_mm > 0.9 * full) at_90 = z;
    if (mg_per_mm > 0.1 * full) at_10 = z;
  }
  EXPECT_GE(at_10 - at_90, 14.0);
  EXPECT_LE(at_10 - at_90, 28.0);
}

TEST(DuctFill, WideDuctFrontHasARoundNose) {
  DuctFill fill(wide_duct(), DuctParams{});
  inject(fill, 0, 1.0, 10.0);
  std::vector<IodinePiece> pieces;
  fill.add_pieces(0.05, pieces);
  EXPECT_NEAR(slab_at(pieces, 15.0).radius_mm, 7.0, 1e-6) << "the full duct";
  const double middle_mm = 10000.0 / (std::numbers::pi * 49.0);
  double before_mm = 7.0;
  for (double z = 15.0; z < middle_mm + 30.0; z += 3.0) {
    EXPECT_LE(slab_at(pieces, z).radius_mm, before_mm + 1e-9);
    before_mm = slab_at(pieces, z).radius_mm;
  }
  EXPECT_LT(before_mm, 0.6 * 7.0);
  for (const IodinePiece& piece : pieces) {
    EXPECT_LE(piece.radius_a_mm, 7.0 + 1e-9);
    EXPECT_LE(piece.iodine_mg_per_ml, 1.05 * kAgent_mg_per_ml)
        << "not denser than the agent, but for cones in a round end";
  }
}

TEST(DuctFill, ClosedEndIsAHemisphereOfTheSameVolume) {
  DuctFill fill(wide_duct(), DuctParams{});
  inject(fill, 40, 2.0, 20.0);
  std::vector<IodinePiece> pieces;
  fill.add_pieces(0.05, pieces);
  double low_z = 0.0, ml = 0.0;
  for (const IodinePiece& piece : pieces) {
    low_z = std::min({low_z, piece.a_P.z(), piece.b_P.z()});
    ml += piece_ml(piece);
    // The half ball around z = 14/3 mm: its flat volume of 2/3 of the radius and a third of it beyond the end.
    const double a = 14.0 / 3.0 - piece.a_P.z(), b = 14.0 / 3.0 - piece.b_P.z();
    if (b > 0.0 && a < 6.9) {
      const double square = 49.0 - (a * a + a * b + b * b) / 3.0;  // its mean over the piece
      EXPECT_NEAR(piece.radius_a_mm * piece.radius_b_mm / square, 1.25, 0.06) << "distended";
    }
  }
  EXPECT_NEAR(low_z, -7.0 / 3.0, 1e-9);
  EXPECT_NEAR(ml, fill.volume_ml(), 0.01 * ml);
}

}  // namespace
}  // namespace trocar::xray
