#pragma once

#include <optional>
#include <vector>

#include "geometry/pose.h"
#include "geometry/segment.h"

namespace trocar::trainer {

/// Where the tools are in one frame. Frame P.
struct ToolsShown {
  std::vector<Vec3> shaft_P;        ///< Hub to tip; empty: no needle.
  Pose X_PN;                        ///< Of the needle's tip.
  std::optional<Segment> goal_P;    ///< Where the hand holds the needle, when it is ahead of it.
  std::optional<Segment> stylet_P;  ///< Of a gun, ahead of its cannula.
  std::optional<Segment> core_P;    ///< Where a core was taken.
  std::optional<Pose> X_PT;         ///< Transducer.
  std::optional<Vec3> focus_P;      ///< Point that the slices go through.
  double inside_mm = 0.0;           ///< Length of the needle in the body.
  bool are_moving = false;
};

/// True where no view would look different.
bool look_same(const ToolsShown& a, const ToolsShown& b);

/// Visible part of the tools from outside the patient: the needle up to the skin.
ToolsShown seen_from_outside(ToolsShown tools);

}  // namespace trocar::trainer
