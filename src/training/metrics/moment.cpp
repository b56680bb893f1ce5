#include "metrics/moment.h"

#include "telemetry/tick_pose.h"

namespace trocar::metrics {

Moment moment_of(const telemetry::TickSample& sample) {
  Moment moment;
  moment.time_s = sample.time_s;
  moment.tip_P = sample.tip_mm;
  moment.axis_P = sample.axis;
  moment.rest_tip_A = sample.rest_tip_mm;
  moment.rest_axis_A = sample.rest_axis;
  moment.R_PN = telemetry::felt_needle(sample).R();
  moment.depth_mm = sample.depth_mm;
  moment.phase = sample.phase;
  moment.events = sample.events;
  moment.resistance_n = telemetry::axial_resistance_n(sample);
  moment.pressed_mm = (sample.rest_tip_mm - telemetry::pierced_rest_tip_mm(sample)).norm();
  return moment;
}

}  // namespace trocar::metrics
