#pragma once

#include <optional>
#include <vector>

#include "geometry/pose.h"
#include "geometry/shapes.h"
#include "motion/patient_motion.h"
#include "scene/scene_view.h"

namespace trocar::trainer {

/// Poses of the tools in one frame. Coordinates in P.
struct ToolsShown {
  motion::PatientMotion motion;     ///< Where the patient is.
  std::vector<Vec3> shaft_P;        ///< Hub to tip; empty: no needle.
  Pose X_PN;                        ///< Pose of the needle's tip.
  std::optional<Segment> goal_P;    ///< Needle at the hand's pose, if the hand is ahead of the needle.
  std::optional<Segment> stylet_P;  ///< Stylet of a biopsy gun, ahead of its cannula.
  std::optional<Segment> core_P;    ///< Place of the core.
  std::optional<Segment> throw_P;   ///< Way of the stylet if the gun were fired now, from the tip on.
  std::optional<Segment> notch_P;   ///< Part of it from which the core would come.
  std::optional<Segment> wire_P;    ///< Guide wire if it went straight on: from the needle's tip as it was advanced.
  std::optional<Pose> X_PT;         ///< Transducer.
  std::optional<Vec3> focus_P;      ///< Focus of the slices.
  std::optional<scene::Fingertip> finger;  ///< Palpating hand.
  std::vector<Vec3> skin_marks_P;          ///< Dots of a skin marker.
  double inside_mm = 0.0;                  ///< Length of the needle in the body.
  bool are_moving = false;
};

/// True if no view would look different.
bool look_same(const ToolsShown& a, const ToolsShown& b);

/// Visible part of the tools from outside the patient: the needle up to the skin.
ToolsShown seen_from_outside(ToolsShown tools);

}  // namespace trocar::trainer
