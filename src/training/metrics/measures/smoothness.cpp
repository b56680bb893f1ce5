#include <array>
#include <cmath>

#include "metrics/detail/uniform_sampler.h"
#include "metrics/measures/groups.h"

// Smoothness of the tip's motion.

namespace trocar::metrics {
namespace {

constexpr std::array kSmoothnessValues{
    MetricDescription{"jerk_rms",
                      "Root mean square jerk of the tip",
                      "mm/s³",
                      Better::kLower,
                      {},
                      "Perk Tutor (Holden 2014), motion smoothness"},
    MetricDescription{
        "dimensionless_jerk", "Dimensionless jerk of the tip", "1", Better::kLower, {}, "Hogan, Sternad 2009"},
    MetricDescription{"log_dimensionless_jerk",
                      "Log dimensionless jerk of the tip",
                      "1",
                      Better::kHigher,
                      {},
                      "Balasubramanian 2015"},
    MetricDescription{"spectral_arc_length",
                      "Spectral arc length of the tip's speed",
                      "1",
                      Better::kHigher,
                      {},
                      "Balasubramanian 2015"},
};
constexpr double kLeastRate_hz = 24.0;
constexpr std::size_t kMostSamples = 32768;  ///< 21 minutes.
constexpr double kLeastSpeed_mm_s = 1e-6;
constexpr double kEnd = 1.5;  ///< Samples without a jerk at each end of a stretch.

class Smoothness : public Metric {
 public:
  void step(const Step& step) override {
    if (step.before != nullptr && step.dt_s <= detail::UniformSampler::kLongestGap_s) {
      ++steps_;
      stepped_s_ += step.dt_s;
    }
    active_s_ = step.active_s;
    sampler_.add(step, [&](const detail::UniformSampler::Sample& sample) { take(sample); });
  }

  void report(const RunEnd&, std::span<MetricValue> values) const override {
    const std::string reason = reason_without_value();
    if (!reason.empty()) {
      for (MetricValue& value : values) value.missing = reason;
      return;
    }
    const double mean_square = has_jerk_ ? (sum_ + kEnd * last_squared_) / (weight_ + kEnd) : sum_ / weight_;
    const double dimensionless = mean_square * std::pow(active_s_, 4) / (peak_mm_s_ * peak_mm_s_);
    values[0].set(std::sqrt(mean_square));
    values[1].set(dimensionless);
    if (dimensionless > 0.0)
      values[2].set(-std::log(dimensionless));
    else
      values[2].missing = "the motion has no jerk";
    const std::optional<double> arc = speeds_.size() < kMostSamples
                                          ? detail::spectral_arc_length(speeds_, detail::UniformSampler::kPeriod_s)
                                          : std::nullopt;
    if (arc)
      values[3].set(*arc);
    else
      values[3].missing = speeds_.size() < kMostSamples ? "the needle did not move" : "the recording is too long";
  }

 private:
  void take(const detail::UniformSampler::Sample& sample) {
    if (!sample.is_joined) begin_stretch();
    const double h_s = detail::UniformSampler::kPeriod_s;
    if (filled_ >= 1) {
      const double speed_mm_s = (sample.tip_P - last_[0]).norm() / h_s;
      peak_mm_s_ = std::max(peak_mm_s_, speed_mm_s);
      if (speeds_.size() < kMostSamples) speeds_.push_back(speed_mm_s);
    }
    if (filled_ >= 3) {
      const Vec3 jerk = (sample.tip_P - 3.0 * last_[0] + 3.0 * last_[1] - last_[2]) / (h_s * h_s * h_s);
      add(jerk.squaredNorm());
    }
    last_ = {sample.tip_P, last_[0], last_[1]};
    filled_ = std::min(3, filled_ + 1);
  }
  /// A stretch of n samples has n - 3 jerks: its first and its last one stand for the samples without one, too.
  void add(double jerk_squared) noexcept {
    const double weight = has_jerk_ ? 1.0 : 1.0 + kEnd;
    sum_ += weight * jerk_squared;
    weight_ += weight;
    last_squared_ = jerk_squared;
    has_jerk_ = true;
  }
  void begin_stretch() noexcept {
    filled_ = 0;
    if (has_jerk_) {
      sum_ += kEnd * last_squared_;
      weight_ += kEnd;
    }
    has_jerk_ = false;
    last_squared_ = 0.0;
  }
  std::string reason_without_value() const {
    if (!(weight_ > 0.0)) return "no 0.16 s are recorded without a gap of more than 1 s";
    if (static_cast<double>(steps_) < kLeastRate_hz * stepped_s_) return "fewer than 24 moments a second";
    if (!(peak_mm_s_ > kLeastSpeed_mm_s)) return "the needle did not move";
    return {};
  }

  detail::UniformSampler sampler_;
  std::array<Vec3, 3> last_{};  // newest first
  int filled_ = 0;
  std::vector<double> speeds_;
  double peak_mm_s_ = 0.0, active_s_ = 0.0, stepped_s_ = 0.0;
  double sum_ = 0.0, weight_ = 0.0;  ///< Of squared jerks.
  double last_squared_ = 0.0;
  bool has_jerk_ = false;  ///< In the present stretch without gaps.
  std::size_t steps_ = 0;
};

}  // namespace

MetricGroup smoothness_metrics() {
  return {kSmoothnessValues,
          [](const MetricContext&) -> std::unique_ptr<Metric> { return std::make_unique<Smoothness>(); }};
}

}  // namespace trocar::metrics

// Travel of the tip and time (Perk Tutor).

namespace trocar::metrics {
namespace {

constexpr std::array kTipPathValues{
    MetricDescription{"elapsed_time", "Elapsed time", "s", Better::kLower, {}, "Perk Tutor (Ungi 2012); Johnson 2012"},
    MetricDescription{
        "path_length", "Path length of the tip", "mm", Better::kLower, {}, "Perk Tutor (Ungi 2012), of means"},
    MetricDescription{
        "path_length_raw", "Path length of the tip, unfiltered", "mm", Better::kLower, {}, "Perk Tutor (Ungi 2012)"},
};

class TipPath : public Metric {
 public:
  void step(const Step& step) override {
    time_s_ = step.active_s;
    if (step.before != nullptr) raw_mm_ += (step.now.tip_P - step.before->tip_P).norm();
    path_.add(step, [this](const auto& from, const auto& to) { length_mm_ += (to.tip_P - from.tip_P).norm(); });
  }
  void report(const RunEnd&, std::span<MetricValue> values) const override {
    double rest_mm = 0.0;
    path_.finish([&](const auto& from, const auto& to) { rest_mm = (to.tip_P - from.tip_P).norm(); });
    values[0].set(time_s_);
    values[1].set(length_mm_ + rest_mm);
    values[2].set(raw_mm_);
  }

 private:
  detail::SmoothPath path_;
  double time_s_ = 0.0, length_mm_ = 0.0, raw_mm_ = 0.0;
};

}  // namespace

MetricGroup tip_path_metrics() {
  return {kTipPathValues, [](const MetricContext&) -> std::unique_ptr<Metric> { return std::make_unique<TipPath>(); }};
}

}  // namespace trocar::metrics
