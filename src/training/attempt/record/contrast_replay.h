#pragma once

#include <map>
#include <memory>
#include <stop_token>

#include "attempt/record/xray_replay.h"
#include "xray/contrast/contrast_flow.h"

namespace trocar::attempt {

/// Contrast agent of a recorded attempt at any time: the flow is computed again from the recorded injections, in steps
/// of InjectionSteps::kStep_s. The state at a time does not depend on the times before it was asked for. Copies of the
/// flow are kept, so that going back is quick. One thread; at() computes for up to some seconds.
class ContrastReplay {
 public:
  /// `iodine_mg_per_ml`: of the agent, 0..500.
  ContrastReplay(xray::ContrastFlow at_rest, std::shared_ptr<const InjectionSteps> injections, double iodine_mg_per_ml);

  /// Contrast agent at a session time; nullptr before the first injection. The same pointer within one step. After a
  /// stop request it is that of an earlier time.
  std::shared_ptr<const xray::Iodine> at(double time_s, const std::stop_token& stop = {});
  /// At the time of the last at().
  xray::ContrastTotals totals() const { return flow_.totals(); }

 private:
  void go_back_to(std::size_t step);
  void advance();
  void keep();

  std::shared_ptr<const InjectionSteps> injections_;
  double iodine_mg_per_ml_;
  xray::ContrastFlow flow_;  ///< At the beginning of step `step_`.
  std::size_t step_ = 0;
  std::size_t keep_every_;
  std::map<std::size_t, xray::ContrastFlow> kept_;  ///< By step; the first is that at rest.
  std::shared_ptr<const xray::Iodine> iodine_;      ///< Of `flow_`; nullptr: not made.
};

}  // namespace trocar::attempt
