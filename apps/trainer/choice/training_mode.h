#pragma once

#include <array>
#include <cstddef>

#include "scene/scene_options.h"

namespace trocar::trainer {

/// How much help the trainee has.
enum class TrainingMode {
  kGuided,    ///< Expert path, entry zone, target, needle direction, predicted force, hints; tools as planned.
  kAssisted,  ///< Entry zone, target, predicted force, and hints; no path; the tools start away from it.
  kExam,      ///< Only images and forces of the unchanged task; the tools start away from the plan.
};
constexpr scene::Guidance guidance_of(TrainingMode mode) noexcept {
  constexpr std::array kOf{scene::Guidance::kPath, scene::Guidance::kTarget, scene::Guidance::kNone};
  return kOf[static_cast<std::size_t>(mode)];
}
/// Name in a session file: "exam".
const char* name_of(TrainingMode mode) noexcept;
/// "Assisted"; help_text_of explains it in one line.
const char* title_of(TrainingMode mode) noexcept;
const char* help_text_of(TrainingMode mode) noexcept;

}  // namespace trocar::trainer
