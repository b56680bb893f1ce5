#include "views/scan_mask.h"

#include <cmath>

namespace trocar::trainer {
namespace {

/// Poses are rounded: a picture that moves with its transducer stays within this.
constexpr double kSame_mm = 0.01;

Vec2 in_plane(const Vec3& v_T) {
  return {v_T.x(), v_T.y()};
}

}  // namespace

const std::vector<std::uint8_t>& ScanMask::of(int columns, int rows, const std::array<Vec3, 3>& corners_P,
                                              const Pose& X_PT, const ScanGeometry& scan) {
  const Pose X_TP = X_PT.inverse();
  Key key;
  key.columns = columns;
  key.rows = rows;
  key.corner_T = in_plane(X_TP * corners_P[0]);
  key.right_T = in_plane(X_TP.R() * (corners_P[1] - corners_P[0]));
  key.down_T = in_plane(X_TP.R() * (corners_P[2] - corners_P[0]));
  key.scan = {scan.is_fan ? 1.0 : 0.0,           scan.radius_mm, scan.line_step, static_cast<double>(scan.lines),
              static_cast<double>(scan.samples), scan.depth_mm};
  const auto near = [](const Vec2& a, const Vec2& b) { return (a - b).norm() < kSame_mm; };
  if (key.columns == key_.columns && key.rows == key_.rows && key.scan == key_.scan &&
      near(key.corner_T, key_.corner_T) && near(key.right_T, key_.right_T) && near(key.down_T, key_.down_T))
    return alpha_;
  key_ = key;
  alpha_.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0);
  std::size_t at = 0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column, ++at) {
      const Vec2 p_T = key.corner_T + (column + 0.5) / columns * key.right_T + (row + 0.5) / rows * key.down_T;
      const Polar place = scan.to_polar(p_T);
      if (place.line >= -0.5 && place.line <= scan.lines - 0.5 && place.depth_mm >= 0.0 &&
          place.depth_mm <= scan.depth_mm)
        alpha_[at] = 255;
    }
  }
  return alpha_;
}

}  // namespace trocar::trainer
