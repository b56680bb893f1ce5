#pragma once

#include <string>

#include "headless/prepare_case.h"

namespace trocar::trainer {

/// How much the trainee is helped.
enum class Difficulty {
  kGuided,    ///< Expert path, entry zone and hints are shown.
  kAssisted,  ///< Hints alone.
  kExam,      ///< Nothing but pictures and forces.
};

/// What is chosen on the start page.
struct SeatChoice {
  std::string task = "liver-biopsy";
  std::string patient = "abdomen";  ///< Embedded patient's name, or a folder.
  std::uint64_t patient_seed = 1;
  std::string needle;       ///< Empty: the task's own.
  std::string force_model;  ///< Empty: the task's own.
  Difficulty difficulty = Difficulty::kGuided;
  std::string needle_device = "mouse";  ///< As trocar-hapticd --device takes it.
};

}  // namespace trocar::trainer
