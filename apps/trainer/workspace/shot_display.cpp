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

}  // namespace trocar::trainer
