// Radiation and contrast agent: the counters of the fluoroscope.
#include <array>

#include "metrics/measures/groups.h"

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
