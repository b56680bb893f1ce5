// Travel of the tip and time (Perk Tutor).
#include <array>

#include "metrics/measures/groups.h"

namespace trocar::metrics {
namespace {

constexpr std::array kTipPathValues{
    MetricDescription{"elapsed_time", "Elapsed time", "s", Better::kLower, {}, "Perk Tutor (Ungi 2012); Johnson 2012"},
    MetricDescription{"path_length", "Path length of the tip", "mm", Better::kLower, {}, "Perk Tutor (Ungi 2012)"},
};

class TipPath : public Metric {
 public:
  void step(const Step& step) override {
    time_s_ = step.active_s;
    if (step.before != nullptr) length_mm_ += (step.now.tip_P - step.before->tip_P).norm();
  }
  void report(const RunEnd&, std::span<MetricValue> values) const override {
    values[0].set(time_s_);
    values[1].set(length_mm_);
  }

 private:
  double time_s_ = 0.0, length_mm_ = 0.0;
};

}  // namespace

MetricGroup tip_path_metrics() {
  return {kTipPathValues, [](const MetricContext&) -> std::unique_ptr<Metric> { return std::make_unique<TipPath>(); }};
}

}  // namespace trocar::metrics
