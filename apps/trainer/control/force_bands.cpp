#include "control/force_bands.h"

#include "anatomy/structure_words.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

QColor color_of(const cases::OpenCase& open, const cases::PathPiece& piece) {
  for (const anatomy::Label& label : open.the_case.patient->label_table.labels)
    if (label.name == piece.name) return {label.color[0], label.color[1], label.color[2]};
  return {0x8a, 0x7a, 0x60};  // unlabelled: fat, the skin's shell
}

}  // namespace

std::vector<ForcePlot::Band> force_bands(const cases::OpenCase& open) {
  std::vector<ForcePlot::Band> bands;
  for (const cases::PathPiece& piece : open.pieces) {
    bands.push_back({piece.from_mm, piece.to_mm, shown(anatomy::structure_words(piece.name)), color_of(open, piece)});
  }
  return bands;
}

std::vector<QPointF> predicted_curve(const cases::OpenCase& open) {
  std::vector<QPointF> curve;
  curve.reserve(open.predicted.size());
  for (const cases::CurvePoint& point : open.predicted) curve.emplace_back(point.tip_mm, point.force_n);
  return curve;
}

}  // namespace trocar::trainer
