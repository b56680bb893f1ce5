#include "attempt/guide/needle_view.h"

#include "anatomy/structure_words.h"
#include "attempt/guide/needle_shaft.h"
#include "telemetry/tick_pose.h"

namespace trocar::attempt {

NeedleView needle_view(const cases::Case& the_case, const telemetry::TickSample& sample,
                       const telemetry::NeedleShape& shape, const Pose& X_PN_goal) {
  NeedleView view;
  view.is_known = true;
  view.time_s = sample.time_s;
  view.X_PN = telemetry::felt_needle(sample);
  view.shaft_P = needle_shaft(sample, shape, the_case.needle.length_mm);
  view.X_PN_device = telemetry::device_pose(sample);
  view.X_PN_goal = X_PN_goal;
  view.resistance_n = telemetry::axial_resistance_n(sample);
  view.lag_mm = (X_PN_goal.p() - sample.tip_mm).dot(view.X_PN.R().col(2));
  view.depth_mm = sample.depth_mm;
  view.speed_mm_s = sample.axial_velocity_mm_s;
  view.phase = sample.phase;
  if (sample.tissue == 0 || sample.tissue >= the_case.tissues.tissues.size()) return view;
  const anatomy::Label* label = sample.tissue == the_case.tissues.skin
                                    ? nullptr
                                    : anatomy::find_label(*the_case.patient, telemetry::pierced_rest_tip_mm(sample));
  view.tissue = anatomy::structure_words(label != nullptr ? label->name : the_case.tissues.tissues[sample.tissue].name);
  return view;
}

}  // namespace trocar::attempt
