#pragma once

#include <QPointF>
#include <vector>

#include "attempt/case/open_case.h"
#include "views/plots/force_plot.h"

namespace trocar::trainer {

/// Tissues along the planned path, in their labels' colours.
std::vector<ForcePlot::Band> force_bands(const attempt::OpenCase& open);
/// What the planned path feels like: depth (mm), resistance (N).
std::vector<QPointF> predicted_curve(const attempt::OpenCase& open);

}  // namespace trocar::trainer
