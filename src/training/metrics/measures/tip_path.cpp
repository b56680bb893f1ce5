// Travel of the tip and time (Perk Tutor).
#include <array>

#include "metrics/detail/smooth_path.h"
#include "metrics/measures/groups.h"

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
