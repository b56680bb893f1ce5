#pragma once

#include <filesystem>

#include "devices/haptic_device.h"

namespace trocar {

/// Tests the device until standard input ends: prints a description of the device, then its state 30 times a second.
/// Lines on standard input: "push" applies a small upward force; "weigh" weighs the stylus (server/stylus_weighing.h)
/// and saves its weight in `stylus_folder` (devices/workspace_map.h; empty: not saved); "forget" deletes the saved
/// weight. Output lines, with tabs between the fields:
///   device NAME TITLE SENSED_DOF PUSH_N HAS_FORCE(0|1)
///   state X_MM Y_MM Z_MM AXIS_X AXIS_Y AXIS_Z BUTTONS IS_THERE(0|1) FORCE_N FAULT ENDED_PUSHES
///   weighing TEXT
///   weighed WEIGHT_N FRICTION_N HORIZONTAL_N SPREAD_N LEVER_MM(- if not measured) TEXT
///   refused TEXT
///   forgot TEXT
/// Position, axis (+z of the stylus) and force in D. TEXT is one line for people. `priority`: under SCHED_FIFO, where
/// it is permitted; 0: ordinary scheduling. Errors: the thread that reads standard input does not start.
Status test_device(devices::HapticDevice& device, double rate_hz, int priority,
                   const std::filesystem::path& stylus_folder);

}  // namespace trocar
