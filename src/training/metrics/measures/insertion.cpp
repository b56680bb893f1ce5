// Counts of punctures, passes, pull-backs and redirections, with hysteresis.
#include <fmt/format.h>

#include <array>
#include <numbers>

#include "metrics/detail/strokes.h"
#include "metrics/measures/groups.h"

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
    if (reference_P_ && angle_between_rad(axis_P, *reference_P_) * 180.0 / std::numbers::pi < kRedirection_deg) return;
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
