// Bevel of the needle against the fibres that it has to part.
#include <algorithm>
#include <array>

#include "metrics/measures/groups.h"
#include "metrics/worst_bevel.h"

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
