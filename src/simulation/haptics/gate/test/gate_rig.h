#pragma once

#include <gtest/gtest.h>

#include "haptics/gate/safety_gate.h"

namespace trocar::testing {

inline haptics::GateInput wanting(const Vec3& force_n, const Vec3& torque_nmm = Vec3::Zero()) {
  haptics::GateInput input;
  input.wanted = {force_n, torque_nmm};
  input.is_wanted = true;
  return input;
}

/// A gate at full force, as after a safe start in air.
inline haptics::GateState open_gate(const haptics::GateParams& params = {}) {
  haptics::GateState state;
  for (int i = 0; i < 5000 && state.mode != telemetry::GateMode::kOn; ++i)
    haptics::step_gate(state, wanting(Vec3::Zero()), params);
  EXPECT_EQ(state.mode, telemetry::GateMode::kOn);
  return state;
}

inline double force_n(const haptics::GateOutput& output) {
  return output.wrench.force_n.norm();
}

}  // namespace trocar::testing
