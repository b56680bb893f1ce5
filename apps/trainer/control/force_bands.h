#pragma once

#include <QPointF>
#include <vector>

#include "cases/open_case.h"
#include "views/plots/force_plot.h"

namespace trocar::trainer {

/// Tissues along the planned path, in their labels' colours.
std::vector<ForcePlot::Band> force_bands(const cases::OpenCase& open);
/// Predicted resistance along the planned path: depth (mm), resistance (N).
std::vector<QPointF> predicted_curve(const cases::OpenCase& open);

}  // namespace trocar::trainer
