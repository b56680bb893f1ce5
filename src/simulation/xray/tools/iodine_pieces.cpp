#include "xray/tools/iodine_pieces.h"

#include <algorithm>

#include "xray/tools/detail/tube_piece.h"

namespace trocar::xray {
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

XrayRays rays_in_body(const XrayRays& rays, const Pose& X_PM) noexcept {
  const Pose X_MP = X_PM.inverse();
  XrayRays moved = rays;
  moved.source_P = X_MP * rays.source_P;
  moved.first_pixel_P = X_MP * rays.first_pixel_P;
  moved.column_P = X_MP.R() * rays.column_P;
  moved.row_P = X_MP.R() * rays.row_P;
  return moved;
}

}  // namespace trocar::xray
