#include "cases/imaging.h"

#include <utility>

#include "core/files/folders.h"
#include "core/log.h"
#include "motion/patient_motion.h"
#include "ultrasound/doppler/vessel_flow.h"

namespace trocar::cases {

metrics::ImagePlane image_plane(const ultrasound::Transducer& transducer, double depth_mm) {
  const bool is_linear = transducer.kind == ultrasound::TransducerKind::kLinear;
  metrics::ImagePlane plane;
  plane.depth_mm = depth_mm;
  plane.field_of_view_rad = is_linear ? 0.0 : transducer.field_of_view_rad;
  plane.radius_mm = is_linear || transducer.kind == ultrasound::TransducerKind::kPhased ? 0.0 : transducer.radius_mm;
  plane.width_mm = transducer.face_width_mm();
  plane.elevation_mm = transducer.elevation_aperture_mm;
  plane.elevation_focus_mm = transducer.elevation_focus_mm;
  return plane;
}

xray::BloodVelocity contrast_blood(const anatomy::VirtualPatient& patient) {
  auto table = ultrasound::load_flow_table(data_dir() / "flow.toml");
  auto flow = table ? ultrasound::make_vessel_flow(patient, *std::move(table))
                    : Result<std::shared_ptr<const ultrasound::VesselFlow>>(tl::make_unexpected(table.error()));
  if (!flow) {
    log_info("contrast agent is not carried along by blood: {}", flow.error().text());
    return {};
  }
  return [flow = *std::move(flow)](const Vec3& p_A, double time_s) {
    return flow->velocity_A(p_A, time_s, motion::state_at({}, time_s).phase);
  };
}

}  // namespace trocar::cases
