#include "xray/contrast/detail/duct_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace trocar::xray::detail {
namespace {

constexpr double kFrontRadii = 4.0;  ///< Length of a front's core, in radii of the duct.
constexpr double kCapLonger =
    1.0 / 3;                      ///< A half ball instead of a flat end of the same volume is longer by this, in radii.
constexpr double kWide_mm = 2.5;  ///< Radius. A thinner duct, some pixels wide, has fewer pieces.
constexpr int kCapPieces = 2;     ///< Of a cell in a round end.
constexpr int kEndPieces = 4;     ///< Of the last cell before a closed end.
constexpr double kWhole = 0.97;   ///< A cell of a higher relative concentration is not in a front.
/// A front is drawn as cores within each other, with parts of equal iodine: the radius falls as these powers of the
/// relative concentration, so that the edge of the whole is soft.
constexpr std::array<double, 3> kCorePowers{0.15, 0.3, 0.5};
constexpr double kSteepGrowth = 0.1;  ///< Growth of the radius per length.
constexpr double kThinnest = 0.02;    ///< Of the cell's radius.
constexpr double kFar_mm = std::numeric_limits<double>::infinity();

/// Height above the pole of the half ball of radius 1 below which it has the volume of a flat cylinder of the length
/// `flat`: the root of 3 h² - h³ = 3 flat in 0..1.
double cap_height(double flat) {
  if (flat >= 2.0 / 3.0) return 1.0;
  return 1.0 + 2.0 * std::cos((std::acos(1.0 - 1.5 * flat) + 4.0 * std::numbers::pi) / 3.0);
}

/// Section of a core.
struct Face {
  Vec3 p_P;
  double radius_mm;
};

/// A cone between two sections; a steep one as a cylinder of its volume, which is drawn much faster.
IodinePiece piece_between(const Face& a, const Face& b) {
  IodinePiece piece{a.p_P, b.p_P, a.radius_mm, b.radius_mm, 0.0};
  if (std::abs(a.radius_mm - b.radius_mm) <= kSteepGrowth * (b.p_P - a.p_P).norm()) return piece;
  const double squares = a.radius_mm * a.radius_mm + a.radius_mm * b.radius_mm + b.radius_mm * b.radius_mm;
  piece.radius_a_mm = piece.radius_b_mm = std::sqrt(squares / 3.0);
  return piece;
}

bool is_joined(const DuctCell& cell) {
  return cell.parent >= 0 && !cell.is_closed;
}

double cone_ml(const IodinePiece& piece) {
  const double a = piece.radius_a_mm, b = piece.radius_b_mm;
  return std::numbers::pi / 3.0 * (a * a + a * b + b * b) * (piece.b_P - piece.a_P).norm() / kMm3PerMl;
}

}  // namespace

DuctOutline::DuctOutline(const DuctTree& tree)
    : fall_(tree.cells.size(), 0.0), to_end_a_(tree.cells.size(), kFar_mm), to_end_b_(tree.cells.size(), kFar_mm) {
  const std::vector<DuctCell>& cells = tree.cells;
  std::vector<int> children(cells.size(), 0);
  for (const DuctCell& cell : cells)
    if (cell.parent >= 0) ++children[static_cast<std::size_t>(cell.parent)];
  for (std::size_t n = 0; n < cells.size(); ++n) {
    const DuctCell& cell = cells[n];
    if (cell.root_end == DuctEnd::kPeripheral || cell.root_end == DuctEnd::kObstructed) to_end_a_[n] = 0.0;
    if (cell.end == DuctEnd::kPeripheral || cell.end == DuctEnd::kObstructed) to_end_b_[n] = 0.0;
    if (!is_joined(cell)) continue;
    const DuctCell& parent = cells[static_cast<std::size_t>(cell.parent)];
    const double length_mm = 0.5 * (cell.length_mm() + parent.length_mm());
    fall_[n] = std::exp(-length_mm / (kFrontRadii * 0.5 * (cell.radius_a_mm + parent.radius_b_mm)));
  }
  // An end that is farther than its own cell, along a duct without branches.
  for (std::size_t n = cells.size(); n-- > 0;) {
    to_end_a_[n] = std::min(to_end_a_[n], to_end_b_[n] + cells[n].length_mm());
    if (!is_joined(cells[n])) continue;
    const auto parent = static_cast<std::size_t>(cells[n].parent);
    if (children[parent] == 1) to_end_b_[parent] = std::min(to_end_b_[parent], to_end_a_[n]);
  }
  for (std::size_t n = 0; n < cells.size(); ++n) {
    if (is_joined(cells[n]) && children[static_cast<std::size_t>(cells[n].parent)] == 1)
      to_end_a_[n] = std::min(to_end_a_[n], to_end_b_[static_cast<std::size_t>(cells[n].parent)]);
    to_end_b_[n] = std::min(to_end_b_[n], to_end_a_[n] + cells[n].length_mm());
  }
}

/// Concentration of each cell, relative to the greatest one near it, less by the distance.
std::vector<double> DuctOutline::find_relative(const DuctTree& tree,
                                               const std::vector<double>& iodine_mg_per_ml) const {
  std::vector<double> most = iodine_mg_per_ml;
  for (std::size_t n = most.size(); n-- > 0;)
    if (is_joined(tree.cells[n])) {
      double& parent = most[static_cast<std::size_t>(tree.cells[n].parent)];
      parent = std::max(parent, fall_[n] * most[n]);
    }
  for (std::size_t n = 0; n < most.size(); ++n)
    if (is_joined(tree.cells[n]))
      most[n] = std::max(most[n], fall_[n] * most[static_cast<std::size_t>(tree.cells[n].parent)]);
  for (std::size_t n = 0; n < most.size(); ++n) most[n] = most[n] > 0.0 ? iodine_mg_per_ml[n] / most[n] : 0.0;
  return most;
}

void DuctOutline::add_pieces(const DuctTree& tree, const std::vector<double>& volume_ml,
                             const std::vector<double>& iodine_mg_per_ml, double least_mg_per_ml,
                             std::vector<IodinePiece>& pieces) const {
  const std::vector<double> relative = find_relative(tree, iodine_mg_per_ml);
  // At a face the larger of the two cores: no piece is denser than the agent behind the front.
  std::vector<double> at_b = relative;
  for (std::size_t n = 0; n < relative.size(); ++n)
    if (is_joined(tree.cells[n])) {
      double& face = at_b[static_cast<std::size_t>(tree.cells[n].parent)];
      face = std::max(face, relative[n]);
    }
  for (std::size_t n = 0; n < relative.size(); ++n) {
    if (iodine_mg_per_ml[n] < least_mg_per_ml) continue;
    const DuctCell& cell = tree.cells[n];
    const double at_a =
        is_joined(cell) ? std::max(relative[n], relative[static_cast<std::size_t>(cell.parent)]) : relative[n];
    const double widened = std::sqrt(volume_ml[n] / cell.volume_ml());
    const double mg = iodine_mg_per_ml[n] * volume_ml[n];
    const bool is_wide = std::max(cell.radius_a_mm, cell.radius_b_mm) > kWide_mm;
    if (relative[n] > kWhole) {
      add_core(cell, n, {widened, widened}, mg, pieces);
      continue;
    }
    if (!is_wide) {
      // Of a thin duct one core: the fourth root is near the mean of the powers.
      const auto factor = [&](double at) { return widened * std::sqrt(std::sqrt(at)); };
      add_core(cell, n, {factor(at_a), factor(at_b[n])}, mg, pieces);
      continue;
    }
    for (const double power : kCorePowers)
      add_core(cell, n, {widened * std::pow(at_a, power), widened * std::pow(at_b[n], power)},
               mg / static_cast<double>(kCorePowers.size()), pieces);
  }
}

/// A cell's cone with its radii times factors. A closed end is half a ball of the volume of the flat end.
void DuctOutline::add_core(const DuctCell& cell, std::size_t n, const std::array<double, 2>& factors, double mg,
                           std::vector<IodinePiece>& pieces) const {
  const double widest_mm = std::max(cell.radius_a_mm, cell.radius_b_mm);
  const bool is_cap = std::min(to_end_a_[n], to_end_b_[n]) < widest_mm;
  if (!is_cap) {
    pieces.push_back(
        piece_between({cell.a_P, factors[0] * cell.radius_a_mm}, {cell.b_P, factors[1] * cell.radius_b_mm}));
    pieces.back().iodine_mg_per_ml = mg / cone_ml(pieces.back());
    return;
  }
  const double length_mm = cell.length_mm();
  const Vec3 along = (cell.b_P - cell.a_P) / length_mm;
  const bool is_end = to_end_a_[n] == 0.0 || to_end_b_[n] == 0.0;
  const bool is_wide = widest_mm > kWide_mm;
  const int count = is_end ? (is_wide ? kEndPieces : 2) : is_wide ? kCapPieces : 1;
  const auto face_at = [&](double f) {
    const double radius_mm = std::lerp(factors[0] * cell.radius_a_mm, factors[1] * cell.radius_b_mm, f);
    const double to_a_mm = to_end_a_[n] + f * length_mm, to_b_mm = to_end_b_[n] + (1.0 - f) * length_mm;
    const double flat_mm = std::min(to_a_mm, to_b_mm);
    const double height = cap_height(flat_mm / widest_mm);
    double place_mm = f * length_mm;
    if (height < 1.0) place_mm += (to_b_mm < to_a_mm ? 1.0 : -1.0) * (flat_mm - (height - kCapLonger) * widest_mm);
    return Face{cell.a_P + place_mm * along,
                radius_mm * std::max(std::sqrt(std::max(height * (2.0 - height), 0.0)), kThinnest)};
  };
  const std::size_t first = pieces.size();
  double ml = 0.0;
  Face before = face_at(0.0);
  for (int k = 1; k <= count; ++k) {
    double f = static_cast<double>(k) / count;
    if (to_end_b_[n] == 0.0) {  // shorter towards the pole
      f *= 2.0 - f;
    } else if (to_end_a_[n] == 0.0) {
      f *= f;
    }
    const Face face = face_at(f);
    pieces.push_back(piece_between(before, face));
    ml += cone_ml(pieces.back());
    before = face;
  }
  for (std::size_t k = first; k < pieces.size(); ++k) pieces[k].iodine_mg_per_ml = mg / ml;
}

}  // namespace trocar::xray::detail
