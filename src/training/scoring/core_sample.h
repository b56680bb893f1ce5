#pragma once

#include <cstdint>

#include "scoring/detail/judgement.h"
#include "scoring/score.h"

namespace trocar::scoring {

/// Role of a core's piece in its task; a BiopsyCore's four lengths are the sums by these parts.
enum class CorePart : std::uint8_t { kOther, kTarget, kOrgan, kVessel };
CorePart part_of(const tasks::Task& task, const anatomy::VirtualPatient& patient, const CorePiece& piece);

/// Distance of the stylet beyond the tip (mm): the needle's throw, or less if bone stops it.
double stylet_throw_mm(const tasks::Task& task, const anatomy::VirtualPatient& patient, const tasks::Needle& needle,
                       const Vec3& tip_P, const Vec3& axis_P);

/// How likely the punctured organ bleeds, by what was done to it; empty for a task whose target is a fluid
/// (tasks::Task::min_organ_path_mm is 0). High with a vessel touched, or two of the following; raised with one of them:
/// many punctures of the organ's surface, a channel with too little organ around it to close.
std::optional<Bleeding> judge_bleeding(const Judgement& judged);

}  // namespace trocar::scoring
