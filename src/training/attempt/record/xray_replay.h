#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "tasks/action.h"
#include "xray/contrast/contrast_flow.h"

namespace trocar::attempt {

/// The fluoroscope at one moment of a recorded attempt. Frame P.
struct XrayMoment {
  tasks::XrayUse use;              ///< As recorded at this moment: C-arm, beam, contrast agent, dose.
  std::optional<double> image_s;   ///< Session time of the exposure on the screen; empty before the first one.
  tasks::XrayUse image;            ///< The use at that exposure: its C-arm made the image.
  bool is_injecting_then = false;  ///< Contrast agent was injected at that exposure.

  bool is_held() const { return image_s.has_value() && !use.is_beam_on; }  ///< Last-image hold.
};

/// `uses`: of a session, by time. With the beam on, the image is of the moment itself; otherwise of the last recorded
/// exposure. Empty before the first use.
std::optional<XrayMoment> xray_moment(std::span<const tasks::XrayUse> uses, double time_s);

/// A step of the injections.
struct InjectionStep {
  Vec3 tip_P = Vec3::Zero();
  double ml_per_s = 0.0;  ///< 0: nothing is injected in this step.
};

/// Injections of an attempt in equal steps from the first to the end of the last one. No steps: no injection.
struct InjectionSteps {
  static constexpr double kStep_s = 1.0 / 30.0;
  double start_s = 0.0;  ///< Session time of the first step.
  std::vector<InjectionStep> steps;
};

/// The volume between two recorded uses was injected from the first to the second one, but at most in the last
/// kNoteGap_s before the second: while nothing changes, no use is recorded. Steps inject at most kMostRate_ml_per_s;
/// the rest follows in the next ones. `tip_P_at`: tip of the needle at a session time.
InjectionSteps injection_steps(std::span<const tasks::XrayUse> uses, const std::function<Vec3(double)>& tip_P_at);
inline constexpr double kNoteGap_s = 0.1;
inline constexpr double kMostRate_ml_per_s = 50.0;  ///< That of ContrastFlow.

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
