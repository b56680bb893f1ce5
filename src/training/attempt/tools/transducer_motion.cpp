#include "attempt/tools/transducer_motion.h"

#include "haptics/contact/contact_face.h"
#include "telemetry/tick_pose.h"

namespace trocar::attempt {

LedTransducer::LedTransducer(const Pose& X_PT)
    : X_PT_(X_PT), X_PT_start_(X_PT * Pose::translation({0.0, -kAboveSkin_mm, 0.0})) {
  hand_.put(X_PT_start_);
  hand_.lead(X_PT, Vec3::Zero(), Vec3::Zero());
}

link::HandTarget LedTransducer::next(double, double dt_s) {
  hand_.step(dt_s);
  link::HandTarget target;
  target.X_PN = hand_.X_P();
  target.v_P = hand_.v_P();
  target.w_P = hand_.w_P();
  return target;
}

Pose LedTransducer::X_PT_to_resume(const telemetry::TickSample& last) const {
  return telemetry::device_pose(last);
}

Pose transducer_room(const Pose& X_PW_of_needle, const Pose& X_PT) noexcept {
  const Pose X_TS = haptics::tool_in_stylus(haptics::make_face(haptics::Tool::kTransducer)).inverse();
  return {X_PW_of_needle.R(), (X_PT * X_TS).p()};
}

}  // namespace trocar::attempt
