// Bevel of the needle against the fibres that it has to part.
#include "tasks/bevel.h"

#include <array>

#include "metrics/measures/groups.h"

namespace trocar::metrics {
namespace {

constexpr std::array kValues{
    MetricDescription{"bevel_to_fibres",
                      "Largest angle between the bevel and the fibres at a puncture of their layer",
                      "deg",
                      Better::kLower,
                      {Role::kEvents, Role::kTask, Role::kPatient, Role::kRoll},
                      "Trocar"},
};

class Bevel : public Metric {
 public:
  explicit Bevel(const MetricContext& context) : context_(context) {}

  void step(const Step& step) override {
    const Moment& now = step.now;
    if (!context_.task->bevel || !now.events || !now.R_PN) return;
    for (const telemetry::TickEvent& event : *now.events) {
      const std::string* const layer = context_.layer_name(event.id);
      if (event.kind != telemetry::EventKind::kPuncture || layer == nullptr || *layer != context_.task->bevel->layer)
        continue;
      has_punctured_ = true;
      const auto fibres_P = tasks::find_fibres(*context_.task, *context_.patient, now.tip_P);
      if (!fibres_P) continue;
      const double angle_deg = tasks::bevel_to_fibres_deg(*now.R_PN, *fibres_P);
      if (worst_deg_ && *worst_deg_ >= angle_deg) continue;
      worst_deg_ = angle_deg;
      at_s_ = now.time_s;
    }
  }
  void report(const RunEnd&, std::span<MetricValue> values) const override {
    if (worst_deg_) return values[0].set(*worst_deg_, at_s_);
    values[0].missing = !context_.task->bevel ? "the task has no rule for the bevel"
                        : has_punctured_      ? "the patient has no fibres there"
                                              : "the layer of the fibres was not punctured";
  }

 private:
  MetricContext context_;
  bool has_punctured_ = false;
  std::optional<double> worst_deg_;
  double at_s_ = 0.0;
};

}  // namespace

MetricGroup bevel_metrics() {
  return {kValues,
          [](const MetricContext& context) -> std::unique_ptr<Metric> { return std::make_unique<Bevel>(context); }};
}

}  // namespace trocar::metrics
