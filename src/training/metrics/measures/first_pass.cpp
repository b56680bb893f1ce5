// First-pass success and time to the target, as studies of needle guidance report them (NeedleTrainer, PMC11583760).
#include <array>

#include "metrics/detail/body.h"
#include "metrics/measures/groups.h"
#include "tasks/task_labels.h"
#include "volume/sampling.h"

namespace trocar::metrics {
namespace {

constexpr const char* kNeedleTrainer = "NeedleTrainer (PMC11583760)";
constexpr std::array kFirstPassValues{
    MetricDescription{"first_pass_success",
                      "Target reached with the first pass (1) or not (0)",
                      "1",
                      Better::kHigher,
                      {Role::kTask, Role::kDepth},
                      kNeedleTrainer},
    MetricDescription{"time_to_target",
                      "Time from the first contact with the skin to the target",
                      "s",
                      Better::kLower,
                      {Role::kTask, Role::kDepth},
                      kNeedleTrainer},
};
constexpr double kWithdrawn_mm = 10.0;  ///< [assumed] A larger withdrawal ends a pass, as for needle_passes.
constexpr double kPierced_mm = 1.0;     ///< [assumed] Depth from which the skin is pierced.
constexpr double kOutside_s = 0.2;      ///< [assumed] Time out of the body after which the skin is pierced again.

/// Whether the place that has to be at the target (the tip, of a biopsy needle the notch's middle after the shot) is
/// there.
class TargetTest {
 public:
  explicit TargetTest(const MetricContext& context)
      : task_(*context.task), patient_(context.patient), paths_(context.expert_paths) {
    if (context.needle && context.needle->is_biopsy) beyond_mm_ = context.needle->notch_middle_mm();
    if (patient_ == nullptr) return;
    labels_.emplace(task_, *patient_);
    has_label_ = !labels_->is_parenchymal() || paths_.empty();
  }

  bool is_possible() const { return has_label_ || !paths_.empty(); }

  bool is_reached(const Step& step) const {
    const Moment& now = step.now;
    if (!step.is_inside() || now.phase == telemetry::InsertionPhase::kLoading) return false;
    if (has_label_ && is_way_in_target(step)) return true;
    if (has_label_ && !(beyond_mm_ > 0.0)) return false;  // fluid or duct: the tip has to be in it
    for (const ExpertPath& path : paths_)
      if ((now.tip_A() - path.line_P.b).norm() <= task_.target_tolerance_mm) return true;
    return false;
  }

 private:
  bool is_in_target(const Vec3& p_P) const {
    const std::uint8_t id = volume::sample_nearest<std::uint8_t>(patient_->labels, p_P, 0);
    return labels_->part(id) == tasks::TaskLabels::Part::kTarget;
  }
  /// At this moment, or on the straight way since the one before: a slow recording may jump over a small target.
  bool is_way_in_target(const Step& step) const {
    const Vec3 to_P = step.now.tip_A() + beyond_mm_ * step.now.axis_A();
    if (is_in_target(to_P)) return true;
    if (step.before == nullptr || !step.before->depth_mm || !(*step.before->depth_mm > 0.0)) return false;
    constexpr double kLongestWay_mm = 50.0;
    const Vec3 from_P = step.before->tip_A() + beyond_mm_ * step.before->axis_A();
    const double length_mm = std::min((to_P - from_P).norm(), kLongestWay_mm);
    const int steps = static_cast<int>(length_mm / detail::kTestedEvery_mm) + 1;
    for (int n = 1; n < steps; ++n)
      if (is_in_target(from_P + (to_P - from_P) * n / steps)) return true;
    return false;
  }

  const tasks::Task& task_;
  const anatomy::VirtualPatient* patient_;
  std::optional<tasks::TaskLabels> labels_;
  std::vector<ExpertPath> paths_;
  double beyond_mm_ = -detail::kInside_mm;  ///< From the tip; of a gun to the notch's middle.
  bool has_label_ = false;  ///< The target is known by its label; in healthy organ only by expert paths.
};

class FirstPass : public Metric {
 public:
  explicit FirstPass(const MetricContext& context) : target_(context) {}

  void step(const Step& step) override {
    if (!step.now.depth_mm || reached_s_) return;
    const double depth_mm = *step.now.depth_mm;
    const bool is_loading = step.now.phase == telemetry::InsertionPhase::kLoading;
    if (!contact_s_ && (depth_mm > 0.0 || is_loading)) contact_s_ = step.active_s;
    if (depth_mm <= 0.0) {
      outside_s_ += step.dt_s;
      is_in_ = false;
    } else if (!is_in_ && depth_mm > kPierced_mm && !is_loading) {
      if (punctures_ == 0 || outside_s_ >= kOutside_s) ++punctures_;
      is_in_ = true;
      outside_s_ = 0.0;
    }
    if (punctures_ == 0) return;
    deepest_mm_ = std::max(deepest_mm_, depth_mm);
    is_withdrawn_ = is_withdrawn_ || depth_mm < deepest_mm_ - kWithdrawn_mm;
    if (!target_.is_reached(step)) return;
    reached_s_ = step.active_s;
    reached_at_s_ = step.now.time_s;
  }

  void report(const RunEnd&, std::span<MetricValue> values) const override {
    if (!target_.is_possible() || punctures_ == 0) {
      for (MetricValue& value : values)
        value.missing =
            punctures_ == 0 ? "the needle was never in the body" : "no patient and no expert path was given";
      return;
    }
    const bool is_first = punctures_ == 1 && !is_withdrawn_;
    values[0].set(reached_s_ && is_first ? 1.0 : 0.0, reached_at_s_);
    values[0].note = !reached_s_      ? "the target was not reached"
                     : punctures_ > 1 ? "the skin was pierced again before"
                     : is_withdrawn_  ? "the needle was withdrawn before"
                                      : "";
    if (reached_s_) {
      values[1].set(*reached_s_ - *contact_s_, reached_at_s_);
    } else {
      values[1].missing = "the target was not reached";
    }
  }

 private:
  TargetTest target_;
  std::optional<double> contact_s_, reached_s_;  ///< Active time.
  std::optional<double> reached_at_s_;           ///< Recording time.
  int punctures_ = 0;                            ///< Of the skin, before the target was reached.
  double deepest_mm_ = 0.0, outside_s_ = 0.0;
  bool is_in_ = false, is_withdrawn_ = false;
};

}  // namespace

MetricGroup first_pass_metrics() {
  return {kFirstPassValues,
          [](const MetricContext& context) -> std::unique_ptr<Metric> { return std::make_unique<FirstPass>(context); }};
}

}  // namespace trocar::metrics
