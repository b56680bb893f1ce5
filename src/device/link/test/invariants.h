#pragma once

#include <cmath>
#include <string>

#include "link/test/field_walk.h"

namespace trocar::link {

/// Checks the invariants of every message that a decoder accepts. Returns the violated ones; empty: none.
template <class Body>
std::string find_broken_invariant(Envelope<Body> message) {
  constexpr double kFar_mm = 1e5;
  constexpr double kRounding = 1e-11;
  std::string broken;
  const auto expect = [&](bool holds, const char* what) {
    if (!holds) broken.append(what).append("; ");
  };
  const auto is_near = [&](const Vec3& p) { return p.norm() <= kFar_mm; };
  const auto check_text = [&](const std::string& text, bool is_table) {
    expect(text.size() <= kMostTextBytes, "text too long");
    for (const char c : text) {
      const bool is_space = is_table && (c == '\t' || c == '\n' || c == '\r');
      expect(static_cast<unsigned char>(c) >= 0x20 || is_space, "control character in a text");
      expect(c != 0x7f, "DEL in a text");
    }
  };
  walk(message,
       Overloaded{
           [&](double& value) { expect(std::isfinite(value), "number not finite"); },
           [&](Pose& X) {
             expect((X.R().transpose() * X.R() - Mat3::Identity()).norm() < kRounding, "no rotation");
             expect(std::abs(X.R().determinant() - 1.0) < kRounding, "mirrored");
             expect(is_near(X.p()), "pose far away");
           },
           [&](std::string& text) { check_text(text, false); },
           [&](ServerCommand& command) { expect(command <= kLastServerCommand, "unknown command"); },
           [&](ServerState& state) { expect(state <= kLastServerState, "unknown state"); },
           [&](telemetry::GateMode& mode) { expect(mode <= last_of(mode), "unknown gate mode"); },
           [&](telemetry::GateFault& fault) { expect(fault <= last_of(fault), "unknown fault"); },
           [&](LoadScene& scene) {
             expect(scene.needle_length_mm >= 0.0 && scene.needle_radius_mm >= 0.0, "negative needle");
             check_text(scene.tissues_toml, true);
             check_text(scene.patient, false);
             expect(scene.X_PW.is_finite(), "room not finite");
           },
           [&](motion::MotionDrive& drive) { expect(motion::check(drive).has_value(), "motion out of its range"); },
           [&](SetParameters& parameters) {
             for (const TissueSetting& setting : parameters.tissues.value_or(std::vector<TissueSetting>())) {
               check_text(setting.row, false);
               check_text(setting.key, false);
               expect(std::isfinite(setting.value.value_or(0.0)), "value of a setting not finite");
             }
             check_text(parameters.force_model, false);
             expect(std::isfinite(parameters.coupling_stiffness_n_per_mm.value_or(0.0)), "stiffness");
             expect(std::isfinite(parameters.coupling_damping_ns_per_mm.value_or(0.0)), "damping");
             check_text(parameters.tissues_toml, true);
           },
           [&](Reply& reply) {
             check_text(reply.text, false);
             for (const std::string& option : reply.options) check_text(option, false);
             check_text(reply.tissues_toml, true);
           },
           [&](telemetry::TickSample& sample) {
             expect(std::isfinite(sample.time_s), "tick without a time");
             expect(is_near(sample.tip_mm) && is_near(sample.device_mm), "tick far away");
             expect(sample.axis.allFinite(), "axis not finite");
             for (const telemetry::TickEvent& event : sample.events)
               expect(event.kind <= last_of(event.kind), "unknown event");
             telemetry::for_each_tick_field([&](const auto& field) {
               if constexpr (requires { last_of(sample.*field.member); })
                 expect(sample.*field.member <= last_of(sample.*field.member), field.name);
             });
           }});
  if constexpr (std::is_same_v<Body, ServerBody>) {
    const auto* batch = std::get_if<StateBatch>(&message.body);
    expect(batch == nullptr || batch->samples.size() <= kMostSamples, "too many ticks");
  }
  return broken;
}

}  // namespace trocar::link
