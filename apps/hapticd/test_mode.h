#pragma once

#include "devices/haptic_device.h"

namespace trocar {

/// Tests the device until standard input ends: prints a description of the device, then its state 30 times a second;
/// the line "push" applies a small upward force. Output lines, with tabs between the fields:
///   device NAME TITLE SENSED_DOF PUSH_N HAS_FORCE(0|1)
///   state X_MM Y_MM Z_MM AXIS_X AXIS_Y AXIS_Z BUTTONS IS_THERE(0|1) FORCE_N FAULT
/// Position and axis (+z of the stylus) in D.
void test_device(devices::HapticDevice& device, double rate_hz);

}  // namespace trocar
