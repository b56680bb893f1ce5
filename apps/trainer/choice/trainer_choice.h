#pragma once

#include <cstdint>
#include <string>

#include "choice/difficulty.h"

namespace trocar::trainer {

/// Selection on the start page.
struct TrainerChoice {
  std::string task = "liver-biopsy";
  std::string patient = "abdomen";  ///< Name of an embedded patient, or a folder.
  std::uint64_t patient_seed = 1;
  std::string needle;       ///< Empty: the default of the task.
  std::string force_model;  ///< Empty: the default of the task.
  Difficulty difficulty = Difficulty::kGuided;
  /// Devices of needle and transducer: values of trocar-hapticd --device. "mouse" is the simulated device with a
  /// workspace for a whole body.
  std::string needle_device = "mouse";
  std::string probe_device = "mouse";
};

}  // namespace trocar::trainer
