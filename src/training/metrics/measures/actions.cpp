// Translational and rotational actions of the needle (Perk Tutor).
#include <array>
#include <numbers>

#include "metrics/detail/uniform_sampler.h"
#include "metrics/measures/groups.h"

namespace trocar::metrics {
namespace {

constexpr const char* kPerkTutor = "Perk Tutor (Holden 2014)";
constexpr std::array kActionValues{
    MetricDescription{"translational_actions", "Translational actions", "1", Better::kLower, {}, kPerkTutor},
    MetricDescription{"rotational_actions", "Rotational actions", "1", Better::kLower, {}, kPerkTutor},
};
constexpr double kFast_mm_s = 50.0;   ///< Perk Tutor, TranslationalActions.
constexpr double kFast_deg_s = 50.0;  ///< Perk Tutor, RotationalActions.
constexpr double kLasting_s = 0.2;    ///< Perk Tutor: a shorter change does not begin or end an action.

/// Counts the periods in which a speed is above a threshold; a change counts when it has lasted kLasting_s.
class ActionCounter {
 public:
  explicit ActionCounter(double threshold) : threshold_(threshold) {}
  void add(double speed, double dt_s) noexcept {
    other_s_ = (speed > threshold_) != is_acting_ ? other_s_ + dt_s : 0.0;
    if (other_s_ <= kLasting_s) return;
    is_acting_ = !is_acting_;
    other_s_ = 0.0;
    if (is_acting_) ++count_;
  }
  double count() const noexcept { return count_; }

 private:
  double threshold_, other_s_ = 0.0, count_ = 0.0;
  bool is_acting_ = false;
};

class Actions : public Metric {
 public:
  void step(const Step& step) override {
    sampler_.add(step, [&](const detail::UniformSampler::Sample& sample) {
      if (sample.is_joined) {
        constexpr double kPeriod_s = detail::UniformSampler::kPeriod_s;
        translations_.add((sample.tip_P - last_.tip_P).norm() / kPeriod_s, kPeriod_s);
        rotations_.add(angle_between_rad(sample.axis_P, last_.axis_P) * 180.0 / std::numbers::pi / kPeriod_s,
                       kPeriod_s);
      }
      last_ = sample;
    });
  }
  void report(const RunEnd&, std::span<MetricValue> values) const override {
    values[0].set(translations_.count());
    values[1].set(rotations_.count());
  }

 private:
  detail::UniformSampler sampler_;
  detail::UniformSampler::Sample last_{};
  ActionCounter translations_{kFast_mm_s}, rotations_{kFast_deg_s};
};

}  // namespace

MetricGroup action_metrics() {
  return {kActionValues, [](const MetricContext&) -> std::unique_ptr<Metric> { return std::make_unique<Actions>(); }};
}

}  // namespace trocar::metrics
