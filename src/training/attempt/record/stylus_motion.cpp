#include "attempt/record/stylus_motion.h"

#include "cases/scene_request.h"
#include "core/files/data_dir.h"
#include "tasks/needle.h"
#include "telemetry/tick_pose.h"

namespace trocar::attempt {

Result<devices::RecordedMotion> stylus_motion(const storage::Session& session) {
  TROCAR_TRY(const std::filesystem::path data, checked_data_dir());
  if (session.samples.empty()) return fail("the session has no ticks", "", "give a recorded session");
  TROCAR_TRY(const tasks::Needle needle, tasks::load_needle(data / "needles.toml", session.info.needle));
  const Pose X_WP = cases::room_in_patient(session.info.plan_P.line_P, needle.length_mm).inverse();
  const Pose X_NS = Pose::translation({0.0, 0.0, -needle.length_mm});
  devices::RecordedMotion motion;
  motion.rate_hz = session.info.rate_hz;
  motion.poses.reserve(session.samples.size());
  for (const telemetry::TickSample& sample : session.samples)
    motion.poses.push_back(X_WP * telemetry::device_pose(sample) * X_NS);
  return motion;
}

}  // namespace trocar::attempt
