#pragma once

#include <cstdint>
#include <string>

#include "choice/difficulty.h"

namespace trocar::trainer {

/// What is chosen on the start page.
struct TrainerChoice {
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
