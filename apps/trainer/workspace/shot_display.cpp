#include "workspace/shot_display.h"

#include <utility>

namespace trocar::trainer {

void show_shot(ToolsShown& tools, const attempt::GunShot& shot, double since_s, double depth_mm) {
  const attempt::GunThrow thrown = attempt::throw_at(shot, since_s, depth_mm);
  tools.shaft_P = attempt::thrown_shaft(std::move(tools.shaft_P), thrown.cannula_mm);
  const double ahead_mm = thrown.stylet_mm - thrown.cannula_mm;
  const std::vector<Vec3> stylet_P = attempt::thrown_shaft(tools.shaft_P, ahead_mm);
  if (stylet_P.size() > tools.shaft_P.size()) tools.stylet_P = Segment{tools.shaft_P.back(), stylet_P.back()};
  const bool is_over = since_s >= attempt::kStyletMoves_s + attempt::kCannulaMoves_s;
  if (is_over && !shot.pieces.empty()) tools.core_P = shot.core_P;
  if (!is_over) tools.are_moving = true;
}

void show_throw(ToolsShown& tools, const tasks::Needle& needle) {
  if (!needle.is_biopsy) return;
  const Vec3 tip_P = tools.X_PN.p(), axis_P = tools.X_PN.R().col(2);
  const double notch_end_mm = needle.throw_mm - needle.dead_space_mm;
  tools.throw_P = Segment{tip_P, tip_P + needle.throw_mm * axis_P};
  tools.notch_P = Segment{tip_P + (notch_end_mm - needle.notch_mm) * axis_P, tip_P + notch_end_mm * axis_P};
}

}  // namespace trocar::trainer
