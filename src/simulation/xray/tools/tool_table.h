#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "xray/tools/tool_shape.h"

namespace trocar::xray {

/// A guide wire, catheter or marker of data/xray_tools.toml, without a place.
struct ToolKind {
  std::string name;   ///< "guide-wire"
  std::string title;  ///< For people.
  double outer_diameter_mm = 1.0;
  double inner_diameter_mm = 0.0;
  Basis material = Basis::kSteel;
  double density_g_per_cm3 = 7.9;
};

/// All kinds of the file. Errors name file, line and key: an unknown or missing key, a number out of range, a bore
/// wider than the tool.
Result<std::vector<ToolKind>> load_tool_kinds(const std::filesystem::path& file);
/// Unknown name: exit status 2, the message lists the names.
Result<ToolKind> load_tool_kind(const std::filesystem::path& file, std::string_view name);

/// A tool of that kind along a curve through points of P: a Catmull–Rom spline in pieces of at most 2 mm. One point: a
/// bead, as long as it is thick, along z.
ToolShape tool_along(const ToolKind& kind, std::span<const Vec3> points_P);

}  // namespace trocar::xray
