#include "xray/tools/iodine_pieces.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

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
