#pragma once

#include <cstdint>

#include "tasks/score.h"

namespace trocar::tasks {

/// What a piece of a core is to its task; a BiopsyCore's four lengths are the sums by these parts.
enum class CorePart : std::uint8_t { kOther, kTarget, kOrgan, kVessel };
CorePart part_of(const Task& task, const anatomy::VirtualPatient& patient, const CorePiece& piece);

/// How far the stylet gets beyond the tip (mm): the needle's throw, less where bone stops it.
double stylet_throw_mm(const Task& task, const anatomy::VirtualPatient& patient, const Needle& needle,
                       const Vec3& tip_P, const Vec3& axis_P);

}  // namespace trocar::tasks
