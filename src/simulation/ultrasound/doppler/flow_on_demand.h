#pragma once

#include <memory>
#include <string>

#include "core/background_job.h"
#include "ultrasound/doppler/vessel_flow.h"

namespace trocar::ultrasound {

/// The blood flow of a patient, computed in the background when it is first used: it takes as long as all else that
/// opening a case computes, and only Doppler needs it. One thread makes all calls, e.g. that of the window.
class FlowOnDemand {
 public:
  FlowOnDemand(std::shared_ptr<const anatomy::VirtualPatient> patient, FlowTable table);

  /// False if no vessel of the patient has flow. Before the computation: if no label has a row of the table.
  bool is_possible() const noexcept { return is_possible_; }
  /// Starts the computation at the first call. Null until it is done, and if it is not possible.
  std::shared_ptr<const VesselFlow> poll();
  /// It has begun and is not done.
  bool is_computing() const noexcept { return job_.has_work(); }

 private:
  std::shared_ptr<const anatomy::VirtualPatient> patient_;
  FlowTable table_;
  BackgroundJob<std::shared_ptr<const VesselFlow>> job_;
  std::shared_ptr<const VesselFlow> flow_;
  bool is_possible_ = false;
};

}  // namespace trocar::ultrasound
