#include "cases/contrast_blood.h"

#include <utility>

#include "core/files/data_dir.h"
#include "core/log.h"
#include "motion/motion_clock.h"
#include "ultrasound/doppler/flow_table.h"
#include "ultrasound/doppler/vessel_flow.h"

namespace trocar::cases {

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
