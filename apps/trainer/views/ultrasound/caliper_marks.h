#pragma once

#include <QPointF>
#include <optional>
#include <span>

#include "ultrasound/scanner/measurements.h"
#include "views/ultrasound/ultrasound_layout.h"

namespace trocar::trainer {

/// Indices of a measurement and of one of its marks.
struct CaliperMark {
  std::size_t item = 0;
  std::size_t mark = 0;
};

/// The nearest mark within 8 points of a position in the view.
std::optional<CaliperMark> find_mark(const PictureMap& map, std::span<const ultrasound::Measurement> measurements,
                                     const QPointF& place);

}  // namespace trocar::trainer
