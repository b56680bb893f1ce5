#pragma once

#include <QString>
#include <cstdint>
#include <string>

#include "choice/training_mode.h"

namespace trocar::trainer {

/// Selection on the start page.
struct TrainerChoice {
  std::string task = "liver-biopsy";
  std::string patient = "abdomen";  ///< Name of an embedded patient, or a folder.
  std::uint64_t patient_seed = 1;
  /// Number of an exam on an embedded patient: the seed of the body. 0: a body that was not practised is drawn.
  std::uint64_t exam_number = 0;
  bool is_body_known = false;   ///< In an exam: an earlier attempt of the person was on the same body.
  bool is_person_named = true;  ///< In an exam: somebody was chosen on the start page.
  bool is_tutorial = false;     ///< The guided first puncture: not recorded for a person.
  std::string needle;           ///< Empty: the default of the task.
  std::string force_model;      ///< Empty: the default of the task.
  std::string breathing;        ///< As motion::parse_breathing() reads it; empty: as the task says. Not in an exam.
  TrainingMode mode = TrainingMode::kGuided;
  /// Devices of needle and transducer: values of trocar-hapticd --device. "mouse" is the simulated device with a
  /// workspace for a whole body.
  std::string needle_device = "mouse";
  std::string probe_device = "mouse";
};

/// True if a body has to be found for the exam: an exam on an embedded patient. A folder has only one body.
bool needs_exam_body(const TrainerChoice& choice);
/// On the body of an exam: its number, and if it is known; then if the result will name nobody. Empty if it is no exam,
/// or before the body is found.
QString exam_text(const TrainerChoice& choice);

}  // namespace trocar::trainer
