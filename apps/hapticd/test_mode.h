#pragma once

#include "devices/haptic_device.h"

namespace trocar {

/// Tries out the device until standard input ends: prints what it is, then its state 30 times a second; the line "push"
/// gives a small force upwards. Lines of fields with tabs between them:
///   device NAME TITLE SENSED_DOF PUSH_N HAS_FORCE(0|1)
///   state X_MM Y_MM Z_MM AXIS_X AXIS_Y AXIS_Z BUTTONS IS_THERE(0|1) FORCE_N FAULT
/// Position and axis (+z of the stylus) in D.
void test_device(devices::HapticDevice& device, double rate_hz);

}  // namespace trocar
