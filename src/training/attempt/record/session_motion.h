#pragma once

#include <utility>
#include <vector>

#include "anatomy/patient.h"
#include "motion/patient_motion.h"
#include "storage/session_file.h"

namespace trocar::attempt {

/// Where the patient of a recorded session was: the session has what drove it and the phase of every tick. A patient
/// without a motion model, and a session recorded without one, are at rest.
class SessionMotion {
 public:
  /// The patient's model outlives this object.
  SessionMotion(const storage::Session& session, const anatomy::VirtualPatient& patient);

  /// At a tick of that session, to the bit; a patient without a model has its phase only.
  motion::PatientMotion at(const telemetry::TickSample& sample) const noexcept;

 private:
  const motion::MotionModel* model_;
  std::vector<std::pair<double, motion::MotionDrive>> drives_;  ///< In force from a time on.
};

}  // namespace trocar::attempt
