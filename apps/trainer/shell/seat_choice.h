#pragma once

#include <array>
#include <string>

#include "cases/prepare_case.h"
#include "scene/guidance.h"

namespace trocar::trainer {

/// How much the trainee is helped.
enum class Difficulty {
  kGuided,    ///< Expert path, entry zone, target, where the needle goes, the force to come, hints; tools as planned.
  kAssisted,  ///< Entry zone, target, the force to come, and hints; no path, and the tools begin away from it.
  kExam,      ///< Nothing but pictures and forces, of the task as it is; the tools begin away from the plan.
};
constexpr scene::Guidance guidance_of(Difficulty difficulty) noexcept {
  constexpr std::array kOf{scene::Guidance::kPath, scene::Guidance::kTarget, scene::Guidance::kNone};
  return kOf[static_cast<std::size_t>(difficulty)];
}
/// "exam": as a session records it.
const char* name_of(Difficulty difficulty) noexcept;
/// "Assisted", and what that means in a line.
const char* title_of(Difficulty difficulty) noexcept;
const char* help_text_of(Difficulty difficulty) noexcept;

/// What is chosen on the start page.
struct SeatChoice {
  std::string task = "liver-biopsy";
  std::string patient = "abdomen";  ///< Embedded patient's name, or a folder.
  std::uint64_t patient_seed = 1;
  std::string needle;       ///< Empty: the task's own.
  std::string force_model;  ///< Empty: the task's own.
  Difficulty difficulty = Difficulty::kGuided;
  std::string needle_device = "mouse";  ///< As trocar-hapticd --device takes it; likewise of the transducer. "mouse"
  std::string probe_device = "mouse";   ///< is the simulated device with room for a whole body.
};

}  // namespace trocar::trainer
