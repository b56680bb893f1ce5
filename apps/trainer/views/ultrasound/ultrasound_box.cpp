#include "views/ultrasound/ultrasound_box.h"

#include <algorithm>
#include <cmath>

namespace trocar::trainer {
namespace {

constexpr double kEdge = 0.03;

}  // namespace

ultrasound::Vec2 box_place(const ultrasound::ScanGeometry& scan, const ultrasound::Vec2& p_T) noexcept {
  const ultrasound::Polar at = scan.to_polar(p_T);
  return {at.line / (scan.lines - 1), at.depth_mm / scan.depth_mm};
}

std::optional<BoxPart> find_box_part(const ultrasound::DopplerBox& box, const ultrasound::Vec2& place) noexcept {
  const bool is_across = place.x() >= box.first_line - kEdge && place.x() <= box.last_line + kEdge;
  const bool is_along = place.y() >= box.near - kEdge && place.y() <= box.far + kEdge;
  if (!is_across || !is_along) return std::nullopt;
  if (std::abs(place.x() - box.first_line) <= kEdge) return BoxPart::kFirst;
  if (std::abs(place.x() - box.last_line) <= kEdge) return BoxPart::kLast;
  if (std::abs(place.y() - box.near) <= kEdge) return BoxPart::kNear;
  if (std::abs(place.y() - box.far) <= kEdge) return BoxPart::kFar;
  return BoxPart::kWhole;
}

ultrasound::DopplerBox moved_box(const ultrasound::DopplerBox& box, BoxPart part, const ultrasound::Vec2& by) noexcept {
  ultrasound::DopplerBox moved = box;
  switch (part) {
    case BoxPart::kWhole: {
      const double across = std::clamp(by.x(), -box.first_line, 1.0 - box.last_line);
      const double along = std::clamp(by.y(), -box.near, 1.0 - box.far);
      // Keeps the box in the image despite rounding.
      return {std::max(0.0, box.first_line + across), std::min(1.0, box.last_line + across),
              std::max(0.0, box.near + along), std::min(1.0, box.far + along)};
    }
    case BoxPart::kFirst:
      moved.first_line = std::clamp(box.first_line + by.x(), 0.0, std::max(0.0, box.last_line - kLeastBox));
      break;
    case BoxPart::kLast:
      moved.last_line = std::clamp(box.last_line + by.x(), std::min(1.0, box.first_line + kLeastBox), 1.0);
      break;
    case BoxPart::kNear:
      moved.near = std::clamp(box.near + by.y(), 0.0, std::max(0.0, box.far - kLeastBox));
      break;
    case BoxPart::kFar:
      moved.far = std::clamp(box.far + by.y(), std::min(1.0, box.near + kLeastBox), 1.0);
      break;
  }
  return moved;
}

}  // namespace trocar::trainer
