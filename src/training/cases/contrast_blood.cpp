#include "cases/contrast_blood.h"

#include <utility>

#include "core/files/data_dir.h"
#include "core/log.h"
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
  return [flow = *std::move(flow)](const Vec3& p_P, double time_s) { return flow->velocity_P(p_P, time_s); };
}

}  // namespace trocar::cases
