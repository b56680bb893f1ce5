// Structures that the tip passed (paper B, evaluation component).
#include <array>

#include "metrics/detail/body.h"
#include "metrics/measures/groups.h"
#include "volume/sampling.h"

namespace trocar::metrics {
namespace {

constexpr std::array kStructureValues{
    MetricDescription{"structures_pierced",
                      "Structures that the tip was in",
                      "1",
                      Better::kLower,
                      {Role::kPatient},
                      "paper B, evaluation component"},
};
constexpr double kFarthestStep_mm = 500.0;  // a longer step is a jump of the recording

class Structures : public Metric {
 public:
  explicit Structures(const MetricContext& context) : patient_(*context.patient) {}

  void step(const Step& step) override {
    if (!step.is_inside()) return;
    note(*step.now.label);
    if (step.before == nullptr) return;
    const Vec3 way_P = step.now.tip_A() - step.before->tip_A();
    const double length_mm = way_P.norm();
    if (length_mm <= detail::kTestedEvery_mm || length_mm > kFarthestStep_mm) return;
    const int steps = static_cast<int>(length_mm / detail::kTestedEvery_mm) + 1;
    for (int n = 1; n < steps; ++n)
      note(volume::sample_nearest<std::uint8_t>(patient_.labels, step.before->tip_A() + way_P * n / steps, 0));
  }
  void report(const RunEnd&, std::span<MetricValue> values) const override {
    values[0].set(static_cast<double>(order_.size()));
    for (const std::uint8_t id : order_) {
      const anatomy::Label* label = patient_.label_table.find(id);
      values[0].note += (values[0].note.empty() ? "" : ", ") + (label != nullptr ? label->name : std::to_string(id));
    }
  }

 private:
  void note(std::uint8_t id) {
    if (id == 0 || is_found_[id]) return;
    is_found_[id] = true;
    order_.push_back(id);
  }

  const anatomy::VirtualPatient& patient_;
  std::array<bool, 256> is_found_{};
  std::vector<std::uint8_t> order_;
};

}  // namespace

MetricGroup structure_metrics() {
  return {kStructureValues, [](const MetricContext& context) -> std::unique_ptr<Metric> {
            return std::make_unique<Structures>(context);
          }};
}

}  // namespace trocar::metrics
