#include "xray/tools/tool_shape.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "config/toml.h"
#include "xray/tools/detail/tube_piece.h"

namespace trocar::xray {
namespace {

std::vector<float>& image_of(MassImage& masses, Basis basis) {
  std::vector<float>& image = masses.of(basis);
  if (image.empty()) image.assign(masses.size(), 0.0F);
  return image;
}

void append(std::vector<detail::TubePiece>& all, std::vector<detail::TubePiece> more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

void add_tools(const std::vector<ToolShape>& tools, const XrayRays& rays, MassImage& masses) {
  masses.columns = rays.columns;
  masses.rows = rays.rows;
  std::array<std::vector<detail::TubePiece>, kBases> pieces;
  for (const ToolShape& tool : tools) {
    const bool is_finite =
        std::all_of(tool.line_P.begin(), tool.line_P.end(), [](const Vec3& p_P) { return p_P.allFinite(); });
    if (!is_finite || !(tool.outer_radius_mm > 0.0)) continue;
    auto& wall = pieces[static_cast<std::size_t>(tool.material)];
    append(wall, detail::pieces_along(tool.line_P, tool.outer_radius_mm, tool.density_g_per_cm3));
    const double bore_mm = std::min(tool.inner_radius_mm, tool.outer_radius_mm);
    if (!(bore_mm > 0.0)) continue;
    append(wall, detail::pieces_along(tool.line_P, bore_mm, -tool.density_g_per_cm3));
    if (tool.filling_iodine_mg_per_ml > 0.0)
      append(pieces[static_cast<std::size_t>(Basis::kIodine)],
             detail::pieces_along(tool.line_P, bore_mm, tool.filling_iodine_mg_per_ml / detail::kMg_per_g));
  }
  for (std::size_t basis = 0; basis < kBases; ++basis)
    if (!pieces[basis].empty()) detail::add_pieces(pieces[basis], rays, image_of(masses, static_cast<Basis>(basis)));
}

namespace {

constexpr double kToolPiece_mm = 2.0;

std::optional<Basis> find_basis(std::string_view name) {
  constexpr std::pair<std::string_view, Basis> kNames[] = {
      {"water", Basis::kWater}, {"bone", Basis::kBone}, {"iodine", Basis::kIodine}, {"steel", Basis::kSteel}};
  for (const auto& [known, basis] : kNames)
    if (known == name) return basis;
  return std::nullopt;
}

Result<ToolKind> read_kind(const std::string& name, const config::TomlTable& row) {
  TROCAR_TRY_STATUS(
      row.check_keys({"title", "outer_diameter_mm", "inner_diameter_mm", "material", "density_g_per_cm3"}));
  ToolKind kind;
  kind.name = name;
  TROCAR_TRY(kind.title, row.string("title"));
  TROCAR_TRY(const config::SourcedNumber outer, config::read_sourced_number(row, "outer_diameter_mm", {0.1, 20.0}));
  TROCAR_TRY(const config::SourcedNumber inner, config::read_sourced_number(row, "inner_diameter_mm", {0.0, 20.0}));
  TROCAR_TRY(const config::SourcedNumber density, config::read_sourced_number(row, "density_g_per_cm3", {0.01, 25.0}));
  TROCAR_TRY(const std::string material, row.string("material"));
  const auto basis = find_basis(material);
  if (!basis)
    return fail(fmt::format("there is no material \"{}\" for a tool", material), row.where(),
                "write water, bone, iodine or steel");
  if (inner.value >= outer.value)
    return fail("the bore is as wide as the tool", row.where(), "give an inner diameter below the outer one");
  kind.outer_diameter_mm = outer.value;
  kind.inner_diameter_mm = inner.value;
  kind.density_g_per_cm3 = density.value;
  kind.material = *basis;
  return kind;
}

/// Point of a Catmull–Rom piece from b to c at a share of it.
Vec3 spline_point(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double t) {
  return 0.5 *
         (2.0 * b + t * (c - a) + t * t * (2.0 * a - 5.0 * b + 4.0 * c - d) + t * t * t * (3.0 * b - a - 3.0 * c + d));
}

}  // namespace

Result<std::vector<ToolKind>> load_tool_kinds(const std::filesystem::path& file) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(file));
  TROCAR_TRY_STATUS(document.check_keys({"tools"}));
  TROCAR_TRY(const config::TomlTable rows, document.table("tools"));
  std::vector<ToolKind> kinds;
  for (const std::string& name : rows.keys()) {
    TROCAR_TRY(const config::TomlTable row, rows.table(name));
    TROCAR_TRY(ToolKind kind, read_kind(name, row));
    kinds.push_back(std::move(kind));
  }
  if (kinds.empty()) return fail("the file lists no tool", file.string(), "add a table [tools.NAME]");
  return kinds;
}

Result<ToolKind> load_tool_kind(const std::filesystem::path& file, std::string_view name) {
  TROCAR_TRY(const std::vector<ToolKind> kinds, load_tool_kinds(file));
  const auto found = std::ranges::find(kinds, name, &ToolKind::name);
  if (found != kinds.end()) return *found;
  std::vector<std::string> names;
  for (const ToolKind& kind : kinds) names.push_back(kind.name);
  return fail_usage(fmt::format("there is no X-ray tool \"{}\"", name), file.string(),
                    fmt::format("known are: {}", fmt::join(names, ", ")));
}

ToolShape tool_along(const ToolKind& kind, std::span<const Vec3> points_P) {
  ToolShape tool;
  tool.name = kind.name;
  tool.outer_radius_mm = 0.5 * kind.outer_diameter_mm;
  tool.inner_radius_mm = 0.5 * kind.inner_diameter_mm;
  tool.material = kind.material;
  tool.density_g_per_cm3 = kind.density_g_per_cm3;
  if (points_P.empty()) return tool;
  if (points_P.size() == 1) {
    const Vec3 half(0.0, 0.0, tool.outer_radius_mm);
    tool.line_P = {points_P[0] - half, points_P[0] + half};
    return tool;
  }
  tool.line_P.push_back(points_P.front());
  for (std::size_t n = 0; n + 1 < points_P.size(); ++n) {
    const Vec3 &b = points_P[n], &c = points_P[n + 1];
    const Vec3 a = n > 0 ? points_P[n - 1] : Vec3(2.0 * b - c);
    const Vec3 d = n + 2 < points_P.size() ? points_P[n + 2] : Vec3(2.0 * c - b);
    const int pieces = std::clamp(static_cast<int>(std::ceil((c - b).norm() / kToolPiece_mm)), 1, 1000);
    for (int k = 1; k <= pieces; ++k) tool.line_P.push_back(spline_point(a, b, c, d, static_cast<double>(k) / pieces));
  }
  return tool;
}

namespace {

constexpr double kBesideDuct_mm = 1.0;  // the tip may be so far outside of the wall: the bevel is in the duct

/// A way through a cell: towards its b, or towards its a.
struct Leg {
  int cell = -1;
  bool is_forward = true;
};

class WireWalk {
 public:
  explicit WireWalk(const DuctTree& tree) : cells_(tree.cells) {}

  Vec3 end_P(const Leg& leg) const { return leg.is_forward ? at(leg).b_P : at(leg).a_P; }
  Vec3 direction_P(const Leg& leg) const {
    const Vec3 along_P = (at(leg).b_P - at(leg).a_P).normalized();
    return leg.is_forward ? along_P : Vec3(-along_P);
  }

  /// The straightest leg behind another one; empty: the duct ends there or is closed.
  std::optional<Leg> next(const Leg& leg) const {
    std::optional<Leg> best;
    double best_dot = -1.0;
    const auto consider = [&](const Leg& other) {
      const double dot = direction_P(other).dot(direction_P(leg));
      if (best && dot <= best_dot) return;
      best = other;
      best_dot = dot;
    };
    const int joint = leg.is_forward ? leg.cell : at(leg).parent;  // the cell at whose b the legs meet
    if (!leg.is_forward && (joint < 0 || at(leg).is_closed)) return std::nullopt;
    if (!leg.is_forward) consider({joint, false});
    for (std::size_t n = 0; n < cells_.size(); ++n)
      if (cells_[n].parent == joint && static_cast<int>(n) != leg.cell && !cells_[n].is_closed)
        consider({static_cast<int>(n), true});
    return best;
  }

 private:
  const DuctCell& at(const Leg& leg) const { return cells_[static_cast<std::size_t>(leg.cell)]; }
  const std::vector<DuctCell>& cells_;
};

}  // namespace

std::vector<Vec3> guide_wire_way(const DuctTree& tree, const Vec3& tip_P, const Vec3& axis_P, double length_mm) {
  std::vector<Vec3> points_P{tip_P};
  if (!(length_mm > 0.0) || !tip_P.allFinite() || !axis_P.allFinite()) return points_P;
  const int cell = tree.find_cell(tip_P, kBesideDuct_mm);
  if (cell < 0) {
    points_P.push_back(tip_P + std::min(length_mm, kWireInTissue_mm) * axis_P);
    return points_P;
  }
  const WireWalk walk(tree);
  Leg leg{cell, true};
  leg.is_forward = walk.direction_P(leg).dot(axis_P) >= 0.0;
  double left_mm = length_mm;
  for (std::optional<Leg> now = leg; now && left_mm > 0.0; now = walk.next(*now)) {
    const Vec3 step_P = walk.end_P(*now) - points_P.back();
    const double step_mm = step_P.norm();
    if (step_mm > 0.0) points_P.push_back(points_P.back() + std::min(1.0, left_mm / step_mm) * step_P);
    left_mm -= step_mm;
  }
  return points_P;
}

namespace {

constexpr double kSoftness = 0.5;  ///< Of an end, as a share of the smaller radius: joints of a bent duct stay even.

bool is_usable(const IodinePiece& piece) noexcept {
  return piece.a_P.allFinite() && piece.b_P.allFinite() && std::min(piece.radius_a_mm, piece.radius_b_mm) >= 0.0 &&
         std::max(piece.radius_a_mm, piece.radius_b_mm) > 0.0 && piece.iodine_mg_per_ml > 0.0 &&
         (piece.b_P - piece.a_P).norm() > 1e-6;
}

}  // namespace

void add_iodine(const std::vector<IodinePiece>& pieces, const XrayRays& rays, std::vector<float>& iodine_g_per_cm2) {
  if (iodine_g_per_cm2.empty())
    iodine_g_per_cm2.assign(static_cast<std::size_t>(rays.columns) * static_cast<std::size_t>(rays.rows), 0.0F);
  std::vector<detail::TubePiece> cones;
  cones.reserve(pieces.size());
  for (const IodinePiece& piece : pieces) {
    if (!is_usable(piece)) continue;
    detail::TubePiece cone;
    cone.a_P = piece.a_P;
    cone.length_mm = (piece.b_P - piece.a_P).norm();
    cone.axis_P = (piece.b_P - piece.a_P) / cone.length_mm;
    cone.radius_a_mm = piece.radius_a_mm;
    cone.radius_b_mm = piece.radius_b_mm;
    cone.end_softness_mm = kSoftness * std::min(piece.radius_a_mm, piece.radius_b_mm);
    cone.has_free_end = true;
    cone.density_g_per_cm3 = piece.iodine_mg_per_ml / detail::kMg_per_g;
    cones.push_back(cone);
  }
  detail::add_pieces(cones, rays, iodine_g_per_cm2);
}

std::vector<IodinePiece> moved_pieces(std::vector<IodinePiece> pieces, const motion::PatientMotion& motion) {
  if (motion.is_rest()) return pieces;
  for (IodinePiece& piece : pieces) {
    const Vec3 middle_A = 0.5 * (piece.a_P + piece.b_P), along_A = piece.b_P - piece.a_P;
    piece.a_P = motion.to_now(piece.a_P);
    piece.b_P = motion.to_now(piece.b_P);
    const Mat3 jacobian = motion.jacobian(middle_A);
    const double volume = jacobian.determinant(), length_mm = along_A.norm();
    const double stretch = length_mm > 0.0 ? (jacobian * along_A).norm() / length_mm : 1.0;
    const double widening = std::sqrt(volume / stretch);
    piece.radius_a_mm *= widening;
    piece.radius_b_mm *= widening;
    piece.iodine_mg_per_ml /= volume;
  }
  return pieces;
}

}  // namespace trocar::xray
