#include "views/ultrasound/scan_mask.h"

#include <algorithm>
#include <cmath>

namespace trocar::trainer {
namespace {

/// Tolerance for rounded poses: an image that moves with its transducer stays within it.
constexpr double kSame_mm = 0.01;

ultrasound::Vec2 in_plane(const Vec3& v_T) {
  return {v_T.x(), v_T.y()};
}

}  // namespace

const std::vector<std::uint8_t>& ScanMask::of(int columns, int rows, const std::array<Vec3, 3>& corners_P,
                                              const Pose& X_PT, const ultrasound::ScanGeometry& scan) {
  const Pose X_TP = X_PT.inverse();
  Key key;
  key.columns = columns;
  key.rows = rows;
  key.corner_T = in_plane(X_TP * corners_P[0]);
  key.right_T = in_plane(X_TP.R() * (corners_P[1] - corners_P[0]));
  key.down_T = in_plane(X_TP.R() * (corners_P[2] - corners_P[0]));
  key.scan = {scan.is_fan ? 1.0 : 0.0, scan.radius_mm, scan.line_step, static_cast<double>(scan.lines), scan.depth_mm};
  const auto known =
      std::find_if(answers_.begin(), answers_.end(), [&](const Answer& answer) { return are_near(key, answer.key); });
  if (known != answers_.end()) return known->alpha;
  if (answers_.size() == kMostAnswers) answers_.pop_back();
  answers_.push_front({key, painted(key, scan)});
  return answers_.front().alpha;
}

bool ScanMask::are_near(const Key& a, const Key& b) {
  const auto near = [](const ultrasound::Vec2& u, const ultrasound::Vec2& v) { return (u - v).norm() < kSame_mm; };
  return a.columns == b.columns && a.rows == b.rows && a.scan == b.scan && near(a.corner_T, b.corner_T) &&
         near(a.right_T, b.right_T) && near(a.down_T, b.down_T);
}

std::vector<std::uint8_t> ScanMask::painted(const Key& key, const ultrasound::ScanGeometry& scan) {
  std::vector<std::uint8_t> alpha(static_cast<std::size_t>(key.columns) * static_cast<std::size_t>(key.rows), 0);
  // Includes half a line's width beyond the outermost lines; avoids one arc tangent per pixel.
  const double half = 0.5 * scan.lines * scan.line_step;
  const double least_cos = scan.is_fan ? std::cos(half) : 0.0;
  const auto is_within = [&](const ultrasound::Vec2& p_T) {
    if (!scan.is_fan) return std::abs(p_T.x()) <= half && p_T.y() >= 0.0 && p_T.y() <= scan.depth_mm;
    const ultrasound::Vec2 from_apex(p_T.x(), p_T.y() + scan.radius_mm);
    const double r_mm = from_apex.norm();
    return r_mm >= scan.radius_mm && r_mm <= scan.radius_mm + scan.depth_mm && from_apex.y() >= r_mm * least_cos;
  };
  std::size_t at = 0;
  for (int row = 0; row < key.rows; ++row) {
    for (int column = 0; column < key.columns; ++column, ++at) {
      const ultrasound::Vec2 p_T =
          key.corner_T + (column + 0.5) / key.columns * key.right_T + (row + 0.5) / key.rows * key.down_T;
      if (is_within(p_T)) alpha[at] = 255;
    }
  }
  return alpha;
}

}  // namespace trocar::trainer
