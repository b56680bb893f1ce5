#include <algorithm>
#include <array>

#include "metrics/attempt_track.h"
#include "metrics/detail/uniform_sampler.h"
#include "metrics/measures/groups.h"

// Translational and rotational actions of the needle (Perk Tutor).

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
        rotations_.add(degrees(angle_between_rad(sample.axis_P, last_.axis_P)) / kPeriod_s, kPeriod_s);
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

// Bevel of the needle against the fibres that it has to part.

namespace trocar::metrics {
namespace {

constexpr std::array kBevelValues{
    MetricDescription{"bevel_to_fibres",
                      "Largest angle between the bevel and the fibres at a puncture of their layer",
                      "deg",
                      Better::kLower,
                      {Role::kEvents, Role::kTask, Role::kPatient, Role::kRoll},
                      "Trocar"},
};

/// Id of a layer in the events of a recording; empty: it has none of this name.
std::optional<std::uint8_t> find_layer(const MetricContext& context) {
  if (!context.task->bevel) return std::nullopt;
  const auto found = std::ranges::find(context.layer_names, context.task->bevel->layer);
  if (found == context.layer_names.end()) return std::nullopt;
  return static_cast<std::uint8_t>(found - context.layer_names.begin());
}

class Bevel : public Metric {
 public:
  explicit Bevel(const MetricContext& context)
      : has_rule_(context.task->bevel.has_value()), bevel_(*context.task, *context.patient, find_layer(context)) {}

  void step(const Step& step) override {
    const Moment& now = step.now;
    if (now.events && now.R_PN) bevel_.step(now.time_s, now.tip_A(), *now.R_PN, *now.events);
  }
  void report(const RunEnd&, std::span<MetricValue> values) const override {
    if (const auto& worst = bevel_.worst()) return values[0].set(worst->to_fibres_deg, worst->time_s);
    values[0].missing = !has_rule_               ? "the task has no rule for the bevel"
                        : bevel_.has_punctured() ? "the patient has no fibres there"
                                                 : "the layer of the fibres was not punctured";
  }

 private:
  bool has_rule_;
  WorstBevel bevel_;
};

}  // namespace

MetricGroup bevel_metrics() {
  return {kBevelValues,
          [](const MetricContext& context) -> std::unique_ptr<Metric> { return std::make_unique<Bevel>(context); }};
}

}  // namespace trocar::metrics

// Radiation and contrast agent: the counters of the fluoroscope.

namespace trocar::metrics {
namespace {

constexpr const char* kFluoroscope = "counters of the fluoroscope (docs/physics.md, X-ray)";
constexpr std::array kXrayValues{
    MetricDescription{"dose_area", "Dose–area product", "Gy·cm²", Better::kLower, {Role::kXray}, kFluoroscope},
    MetricDescription{
        "air_kerma", "Air kerma at the reference point", "mGy", Better::kLower, {Role::kXray}, kFluoroscope},
    MetricDescription{"beam_time", "Time with the beam on", "s", Better::kLower, {Role::kXray}, kFluoroscope},
    MetricDescription{"contrast_volume", "Injected contrast agent", "ml", Better::kLower, {Role::kXray}, kFluoroscope},
};

class XrayCounters : public Metric {
 public:
  void step(const Step& step) override {
    if (step.now.xray) last_ = *step.now.xray;
  }
  void report(const RunEnd&, std::span<MetricValue> values) const override {
    values[0].set(last_.dose_area_gycm2);
    values[1].set(last_.air_kerma_mgy);
    values[2].set(last_.beam_s);
    values[3].set(last_.contrast_ml);
  }

 private:
  tasks::XrayUse last_;
};

}  // namespace

MetricGroup xray_metrics() {
  return {kXrayValues,
          [](const MetricContext&) -> std::unique_ptr<Metric> { return std::make_unique<XrayCounters>(); }};
}

}  // namespace trocar::metrics
