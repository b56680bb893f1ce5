#include "xray/tools/tool_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "config/sourced_number.h"
#include "config/toml.h"

namespace trocar::xray {
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

}  // namespace trocar::xray
