#include "tasks/postures.h"

#include <algorithm>

namespace trocar::tasks {

std::vector<anatomy::Posture> postures_to_try(const Task& task, const anatomy::VirtualPatient& patient) {
  if (task.posture) return {*task.posture};
  if (task.postures.empty()) return {patient.posture};
  std::vector<anatomy::Posture> postures = task.postures;
  const auto own = std::ranges::find(postures, patient.posture);
  if (own != postures.end()) std::rotate(postures.begin(), own, own + 1);
  return postures;
}

anatomy::Posture posture_of(const Task& task, const anatomy::VirtualPatient& patient) {
  return postures_to_try(task, patient).front();
}

}  // namespace trocar::tasks
