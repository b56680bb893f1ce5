#pragma once

#include <array>
#include <cstddef>

#include "scene/guidance.h"

namespace trocar::trainer {

/// Level of help for the trainee.
enum class Difficulty {
  kGuided,    ///< Expert path, entry zone, target, needle direction, predicted force, hints; tools as planned.
  kAssisted,  ///< Entry zone, target, predicted force, and hints; no path; the tools start away from it.
  kExam,      ///< Only images and forces of the unchanged task; the tools start away from the plan.
};
constexpr scene::Guidance guidance_of(Difficulty difficulty) noexcept {
  constexpr std::array kOf{scene::Guidance::kPath, scene::Guidance::kTarget, scene::Guidance::kNone};
  return kOf[static_cast<std::size_t>(difficulty)];
}
/// Name in a session file: "exam".
const char* name_of(Difficulty difficulty) noexcept;
/// "Assisted"; help_text_of explains it in one line.
const char* title_of(Difficulty difficulty) noexcept;
const char* help_text_of(Difficulty difficulty) noexcept;

}  // namespace trocar::trainer
