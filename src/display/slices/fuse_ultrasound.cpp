#include "slices/fuse_ultrasound.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"

namespace trocar::slices {
namespace {

constexpr std::array<double, 3> kOrange{1.0, 0.6, 0.15};

std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

/// The CT becomes darker as the ultrasound becomes stronger, so that their sum is not saturated.
volume::Rgb blend(const volume::Rgb& ct, double us, double share) {
  volume::Rgb out;
  for (std::size_t c = 0; c < 3; ++c) out[c] = to_byte((1.0 - share) * ct[c] + share * 1.4 * kOrange[c] * us);
  return out;
}

}  // namespace

void fuse_ultrasound(const PlacedUltrasound& ultrasound, const volume::SlicePlane& plane, const FusionStyle& style,
                     volume::RgbImage& picture) {
  TROCAR_CHECK(picture.columns == plane.columns && picture.rows == plane.rows);
  if (style.kind == FusionKind::kOff) return;
  const Pose X_UP = ultrasound.X_PU.inverse();
  const Vec3 right_P = plane.step_u_P.normalized(), down_P = plane.step_v_P.normalized();
  const double share = std::clamp(style.share, 0.0, 1.0);
  for (int row = 0; row < plane.rows; ++row)
    for (int column = 0; column < plane.columns; ++column) {
      const Vec3 p_P = plane.origin_P + column * plane.step_u_P + row * plane.step_v_P;
      const Vec3 p_U = X_UP * p_P;
      if (volume::sample_nearest(ultrasound.imaged_U, p_U, std::uint8_t{0}) == 0) continue;
      const double us = std::min(255.0, 255.0 * volume::sample_linear(ultrasound.gray_U, p_U) / ultrasound.white);
      volume::Rgb& pixel = picture.at(column, row);
      if (style.kind == FusionKind::kBlend) {
        pixel = blend(pixel, us, share);
        continue;
      }
      const double field = std::floor(right_P.dot(p_P) / style.field_mm) + std::floor(down_P.dot(p_P) / style.field_mm);
      if ((std::lround(field) & 1) == 0) pixel.fill(to_byte(us));
    }
}

}  // namespace trocar::slices
