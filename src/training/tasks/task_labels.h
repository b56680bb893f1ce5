#pragma once

#include <array>
#include <cstdint>

#include "anatomy/patient.h"
#include "tasks/task.h"

namespace trocar::tasks {

/// Role of each label of a patient in a task.
class TaskLabels {
 public:
  TaskLabels(const Task& task, const anatomy::VirtualPatient& patient);

  enum class Part : std::uint8_t { kOther, kTarget, kOrgan, kVessel };
  Part part(std::uint8_t label_id) const noexcept { return parts_[label_id]; }
  /// The risk structure that a label belongs to, nullptr for none.
  const RiskStructure* risk(std::uint8_t label_id) const noexcept { return risks_[label_id]; }
  /// What a needle does to it at worst.
  Harm harm(std::uint8_t label_id) const noexcept { return harms_[label_id]; }
  bool is_bone(std::uint8_t label_id) const noexcept { return is_bone_[label_id]; }
  /// The patient has no lesion of the task: its organ's healthy tissue is the target.
  bool is_parenchymal() const noexcept { return is_parenchymal_; }

 private:
  std::array<Part, 256> parts_{};
  std::array<const RiskStructure*, 256> risks_{};  // into the task
  std::array<Harm, 256> harms_{};
  std::array<bool, 256> is_bone_{};
  bool is_parenchymal_ = true;
};

}  // namespace trocar::tasks
