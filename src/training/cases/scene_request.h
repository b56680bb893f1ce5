#pragma once

#include <string>
#include <vector>

#include "anatomy/tissue/tissue_settings.h"
#include "cases/prepare_case.h"
#include "haptics/needle_geometry.h"
#include "link/messages.h"
#include "tasks/needle.h"

namespace trocar::cases {

/// Options of a scene request to a server.
struct SceneChoice {
  std::string tool = "needle";
  std::string force_model;  ///< Empty: the task's.
  /// Source that the server can open: a folder of its machine, or an embedded patient's name.
  std::string patient_source;
  std::uint64_t patient_seed = 1;
  std::uint64_t seed = 1;
};
link::LoadScene scene_request(const Case& the_case, const SceneChoice& choice);

/// Message with all numbers of tissues that differ from the scene's table.
link::SetParameters tissue_parameters(const std::vector<anatomy::TissueSetting>& settings);

/// Pose of the room for a supine patient: the user is at the patient's right side (W: x towards the feet, y to the
/// patient's left, z up). The origin is the grip with the needle inserted half-way, so that a centred workspace covers
/// the whole puncture.
Pose room_in_patient(const Segment& path_P, double needle_length_mm) noexcept;

/// Geometry of a listed needle for the force models: of steel, with its grip at the hub.
haptics::NeedleGeometry needle_geometry(const tasks::Needle& needle) noexcept;

}  // namespace trocar::cases
