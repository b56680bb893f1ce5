#include "xray/tools/tool_shape.h"

#include <algorithm>

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

}  // namespace trocar::xray
