#include "ultrasound/doppler/flow_on_demand.h"

#include <algorithm>
#include <utility>

#include "core/live/live_schedule.h"
#include "core/log.h"
#include "core/parallel.h"

namespace trocar::ultrasound {
namespace {

constexpr int kFlowNiceness = 5;  // as the live scanner's thread

/// On one thread of low priority: haptic servers and the window run at the same time.
Result<std::shared_ptr<const VesselFlow>> make_beside_attempt(const anatomy::VirtualPatient& patient,
                                                              const FlowTable& table, const Progress& progress,
                                                              const std::stop_token& stop) {
  lower_priority(kFlowNiceness);
  Result<std::shared_ptr<const VesselFlow>> flow = nullptr;
  run_on_threads(1, [&] { flow = make_vessel_flow(patient, table, {}, progress, stop); });
  return flow;
}

}  // namespace

FlowOnDemand::FlowOnDemand(std::shared_ptr<const anatomy::VirtualPatient> patient, FlowTable table)
    : patient_(std::move(patient)), table_(std::move(table)) {
  const anatomy::LabelTable& labels = patient_->label_table;
  is_possible_ = std::ranges::any_of(labels.labels, [&](const anatomy::Label& label) {
    return is_vessel(label) && table_.find(label.name, labels) != nullptr;
  });
}

std::shared_ptr<const VesselFlow> FlowOnDemand::poll() {
  if (!is_possible_ || flow_) return flow_;
  if (!job_.has_work()) {
    job_ = BackgroundJob<std::shared_ptr<const VesselFlow>>(
        [patient = patient_, table = table_](const Progress& progress, const std::stop_token& stop) {
          return make_beside_attempt(*patient, table, progress, stop);
        });
  }
  auto made = job_.take();
  if (!made) return nullptr;
  job_ = {};
  if (*made) {
    flow_ = **std::move(made);
  } else {
    log_warning("no colour Doppler: {}", made->error().text());
    is_possible_ = false;
  }
  return flow_;
}

}  // namespace trocar::ultrasound
