#pragma once

#include <memory>
#include <string>

#include "core/background_job.h"
#include "ultrasound/doppler/vessel_flow.h"

namespace trocar::ultrasound {

/// Blood flow of a patient, computed in the background at its first use, because the computation takes as long as the
/// rest of opening a case and only Doppler needs it. One thread makes all calls, e.g. that of the window.
class FlowOnDemand {
 public:
  FlowOnDemand(std::shared_ptr<const anatomy::VirtualPatient> patient, FlowTable table);

  /// False if no vessel of the patient has flow. Before the computation: false if no label has a row in the table.
  bool is_possible() const noexcept { return is_possible_; }
  /// Starts the computation at the first call. Returns null until the computation is done, and if it is not possible.
  std::shared_ptr<const VesselFlow> poll();
  /// True while the computation runs.
  bool is_computing() const noexcept { return job_.has_work(); }

 private:
  std::shared_ptr<const anatomy::VirtualPatient> patient_;
  FlowTable table_;
  BackgroundJob<std::shared_ptr<const VesselFlow>> job_;
  std::shared_ptr<const VesselFlow> flow_;
  bool is_possible_ = false;
};

}  // namespace trocar::ultrasound
