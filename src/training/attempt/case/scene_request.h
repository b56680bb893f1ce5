#pragma once

#include <string>
#include <vector>

#include "anatomy/tissue/tissue_setting.h"
#include "attempt/case/prepare_case.h"
#include "link/messages.h"

namespace trocar::attempt {

/// How a scene is asked of a server.
struct SceneChoice {
  std::string tool = "needle";
  std::string force_model;     ///< Empty: the task's.
  std::string patient_source;  ///< As the server can open it: a folder of its machine, or an embedded patient's name.
  std::uint64_t patient_seed = 1;
  std::uint64_t seed = 1;
};
link::LoadScene scene_request(const Case& the_case, const SceneChoice& choice);

/// All numbers of tissues that differ from the scene's table, as the link carries them.
link::SetParameters tissue_parameters(const std::vector<anatomy::TissueSetting>& settings);

/// Where the room stands about a supine patient: who works sits at the patient's right side and looks across (W: x
/// towards the feet, y to the patient's left, z up). The origin is where the grip is when the needle is half-way in, so
/// that a device's workspace, centred there, holds the whole puncture.
Pose room_in_patient(const Segment& path_P, double needle_length_mm) noexcept;

}  // namespace trocar::attempt
