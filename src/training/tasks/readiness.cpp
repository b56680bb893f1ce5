#include "tasks/readiness.h"

#include <fmt/format.h>

#include "tasks/fit_to_patient.h"
#include "tasks/plan.h"

namespace trocar::tasks {

TaskReadiness check_task_and_paths(const Task& general, const anatomy::VirtualPatient& patient, const Needle& needle,
                                   const Progress& progress) {
  const Task task = fit_to_patient(general, patient);
  TaskReadiness readiness = check_task(task, patient);
  if (!readiness.is_possible) return readiness;
  const auto paths = plan_paths(task, patient, needle, {}, progress);
  if (paths) {
    const anatomy::Posture posture = paths->front().posture;
    if (posture == patient.posture) return readiness;
    readiness.posture = posture;
    readiness.reasons.push_back(fmt::format("done with the patient {}, who is {} in the scan",
                                            anatomy::posture_words(posture), anatomy::posture_words(patient.posture)));
    return readiness;
  }
  readiness.is_possible = false;
  readiness.reasons.push_back(paths.error().what);
  return readiness;
}

}  // namespace trocar::tasks
