#include "views/ultrasound/caliper_marks.h"

#include <cmath>

namespace trocar::trainer {

std::optional<CaliperMark> find_mark(const PictureMap& map, std::span<const ultrasound::Measurement> measurements,
                                     const QPointF& place) {
  constexpr double kGrip_px = 8.0;
  std::optional<CaliperMark> found;
  double nearest_px = kGrip_px;
  for (std::size_t item = 0; item < measurements.size(); ++item) {
    const std::vector<ultrasound::Vec2> marks = ultrasound::marks_T(measurements[item]);
    for (std::size_t mark = 0; mark < marks.size(); ++mark) {
      const QPointF away = map.to_view(marks[mark]) - place;
      const double away_px = std::hypot(away.x(), away.y());
      if (away_px > nearest_px) continue;
      nearest_px = away_px;
      found = CaliperMark{item, mark};
    }
  }
  return found;
}

}  // namespace trocar::trainer
