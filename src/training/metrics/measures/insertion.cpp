#include <fmt/format.h>

#include <array>

#include "metrics/detail/body.h"
#include "metrics/detail/uniform_sampler.h"
#include "metrics/measures/groups.h"
#include "tasks/fit_to_patient.h"
#include "volume/sampling.h"

// Counts of punctures, passes, pull-backs and redirections, with hysteresis.

namespace trocar::metrics {
namespace {

constexpr std::array kInsertionValues{
    MetricDescription{"skin_punctures",
                      "Punctures of the skin",
                      "1",
                      Better::kLower,
                      {Role::kDepth},
                      "Perk Tutor, tissue punctures (hysteresis)"},
    MetricDescription{"layer_punctures",
                      "Punctures of layers",
                      "1",
                      Better::kLower,
                      {Role::kDepth, Role::kEvents},
                      "paper A, punctures"},
    MetricDescription{"needle_passes", "Passes of the needle", "1", Better::kLower, {Role::kDepth}, "Trocar"},
    MetricDescription{"pull_backs",
                      "Pull-backs inside the body",
                      "1",
                      Better::kLower,
                      {Role::kDepth},
                      "Hakime (pull-backs of residents)"},
    MetricDescription{"redirections", "Redirections inside the body", "1", Better::kLower, {Role::kDepth}, "Trocar"},
    MetricDescription{"inward_travel",
                      "Inward travel of the tip",
                      "mm",
                      Better::kLower,
                      {Role::kDepth},
                      "Johnson 2012, needle distance"},
};
constexpr double kPass_mm = 10.0;         ///< [assumed] Least advance of a pass, and withdrawal before another one.
constexpr double kPullBack_mm = 2.0;      ///< [assumed] Least withdrawal of a pull-back; tremor is below 1 mm.
constexpr double kBackAgain_mm = 2.0;     ///< [assumed] Withdrawal after which the same layer counts again.
constexpr double kOutAgain_s = 0.2;       ///< [assumed] Time out of the body after which the skin counts again.
constexpr double kInside_mm = 1.0;        ///< [assumed] Depth from which the skin is punctured, without events.
constexpr double kRedirection_deg = 5.0;  ///< [assumed]
constexpr double kAdvance_mm = 5.0;       ///< [assumed] A turn without an advance is none.

/// Punctures of layers from events, of the skin without them.
class PunctureCounter {
 public:
  explicit PunctureCounter(const MetricContext& context) : names_(context.layer_names) {}

  void step(const Step& step) {
    const double depth_mm = *step.now.depth_mm;
    out_s_ = depth_mm > 0.0 ? out_s_ : out_s_ + step.dt_s;
    for (std::size_t id = 0; id < known_; ++id) shallowest_mm_[id] = std::min(shallowest_mm_[id], depth_mm);
    if (!is_in_ && depth_mm > kInside_mm && step.now.phase != telemetry::InsertionPhase::kLoading) {
      if (by_depth_ == 0 || out_s_ >= kOutAgain_s) ++by_depth_;
      is_in_ = true;
      out_s_ = 0.0;
    }
    if (depth_mm <= 0.0) is_in_ = false;
    if (!step.now.events) return;
    for (const telemetry::TickEvent& event : *step.now.events)
      if (event.kind == telemetry::EventKind::kPuncture) puncture(event.id, depth_mm);
  }

  /// By events; a model without puncture events enters by depth.
  double skin() const {
    for (std::size_t id = 0; id < names_.size() && id < counts_.size(); ++id)
      if (names_[id] == "skin" && counts_[id] > 0) return counts_[id];
    return by_depth_;
  }
  double all() const {
    double sum = 0.0;
    for (const int count : counts_) sum += count;
    return sum;
  }
  std::string text() const {
    std::string text;
    for (std::size_t id = 0; id < counts_.size(); ++id) {
      if (counts_[id] == 0) continue;
      const std::string name = id < names_.size() ? names_[id] : fmt::format("#{}", id);
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, counts_[id]);
    }
    return text;
  }

 private:
  void puncture(std::uint8_t id, double depth_mm) {
    double& shallowest_mm = shallowest_mm_[id];
    if (shallowest_mm > punctured_mm_[id] - kBackAgain_mm && counts_[id] > 0 && shallowest_mm > 0.0) return;
    ++counts_[id];
    known_ = std::max(known_, std::size_t{id} + 1);
    punctured_mm_[id] = shallowest_mm = depth_mm;
  }

  std::vector<std::string> names_;
  std::array<int, 256> counts_{};
  std::array<double, 256> punctured_mm_{};   // depth of the last counted puncture, by layer
  std::array<double, 256> shallowest_mm_{};  // since then
  std::size_t known_ = 0;                    // layers with a smaller id may have been punctured
  int by_depth_ = 0;
  bool is_in_ = false;
  double out_s_ = 0.0;
};

/// Changes of the direction in which the needle is advanced. Only its way counts, not its speed: after each advance by
/// kAdvance_mm its axis is compared with that of the advance of the last change.
class RedirectionCounter {
 public:
  void step(const Step& step) {
    if (!step.is_inside()) {
      reference_P_.reset();
      mark_mm_ = 0.0;
      return;
    }
    const double depth_mm = *step.now.depth_mm;
    mark_mm_ = std::min(mark_mm_, depth_mm);
    if (depth_mm < mark_mm_ + kAdvance_mm) return;
    mark_mm_ = depth_mm;
    const Vec3& axis_P = step.now.axis_P;
    if (reference_P_ && degrees(angle_between_rad(axis_P, *reference_P_)) < kRedirection_deg) return;
    if (reference_P_) ++count_;
    reference_P_ = axis_P;
  }
  double count() const noexcept { return count_; }

 private:
  std::optional<Vec3> reference_P_;
  double mark_mm_ = 0.0;  ///< Depth from which the present advance is measured.
  double count_ = 0.0;
};

class Insertion : public Metric {
 public:
  explicit Insertion(const MetricContext& context) : punctures_(context) {}

  void step(const Step& step) override {
    if (!step.now.depth_mm) return;
    punctures_.step(step);
    redirections_.step(step);
    const double depth_mm = *step.now.depth_mm;
    if (passes_.add(depth_mm) == detail::Strokes::Turn::kIn) ++pass_count_;
    travel_.add(depth_mm);
    const detail::Strokes::Turn turn = small_.add(depth_mm);
    if (turn == detail::Strokes::Turn::kOut) is_back_ = true;
    if (depth_mm <= 0.0) is_back_ = false;
    if (turn == detail::Strokes::Turn::kIn && is_back_) {
      ++pull_back_count_;
      is_back_ = false;
      pull_back_s_ = step.now.time_s;
    }
  }
  void report(const RunEnd&, std::span<MetricValue> values) const override {
    values[0].set(punctures_.skin());
    values[1].set(punctures_.all());
    values[1].note = punctures_.text();
    values[2].set(pass_count_);
    values[3].set(pull_back_count_, pull_back_s_);
    values[4].set(redirections_.count());
    values[5].set(travel_.travel_mm());
  }

 private:
  PunctureCounter punctures_;
  RedirectionCounter redirections_;
  detail::Strokes passes_{kPass_mm}, small_{kPullBack_mm}, travel_{detail::kTremor_mm, true};
  double pass_count_ = 0.0, pull_back_count_ = 0.0;
  std::optional<double> pull_back_s_;
  bool is_back_ = false;
};

}  // namespace

MetricGroup insertion_metrics() {
  return {kInsertionValues,
          [](const MetricContext& context) -> std::unique_ptr<Metric> { return std::make_unique<Insertion>(context); }};
}

}  // namespace trocar::metrics

// First-pass success and time to the target, as studies of needle guidance report them (NeedleTrainer, PMC11583760).

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
