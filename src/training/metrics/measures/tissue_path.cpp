// Travel, time and damage inside the body (Perk Tutor; Johnson 2012, needle distance).
#include <array>

#include "metrics/detail/body.h"
#include "metrics/measures/groups.h"

namespace trocar::metrics {
namespace {

constexpr std::array kTissuePathValues{
    MetricDescription{"path_in_tissue",
                      "Path length of the tip inside the body",
                      "mm",
                      Better::kLower,
                      {Role::kDepth},
                      "Perk Tutor (Ungi 2012); Johnson 2012, needle distance"},
    MetricDescription{"time_in_tissue",
                      "Time of the tip inside the body",
                      "s",
                      Better::kLower,
                      {Role::kDepth},
                      "Perk Tutor (Ungi 2012)"},
    MetricDescription{"tissue_damage",
                      "Area swept by the shaft inside the body",
                      "mm²",
                      Better::kLower,
                      {Role::kDepth},
                      "Perk Tutor (Ungi 2012)"},
    MetricDescription{
        "depth_max", "Largest depth of the tip below the skin", "mm", Better::kNeither, {Role::kDepth}, "Trocar"},
};

double triangle_mm2(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  return 0.5 * (b - a).cross(c - a).norm();
}

class TissuePath : public Metric {
 public:
  void step(const Step& step) override {
    const Moment& now = step.now;
    if (now.depth_mm && *now.depth_mm > deepest_mm_) {
      deepest_mm_ = *now.depth_mm;
      deepest_s_ = now.time_s;
    }
    if (step.before == nullptr || !now.depth_mm || !step.before->depth_mm) return;
    const Moment& before = *step.before;
    const double length_mm = (now.tip_P - before.tip_P).norm();
    const double share = detail::share_inside(*before.depth_mm, *now.depth_mm, length_mm);
    length_mm_ += share * length_mm;
    time_s_ += share * step.dt_s;
    if (!(*before.depth_mm > 0.0 && *now.depth_mm > 0.0)) return;
    const Vec3 skin_before_P = before.tip_P - *before.depth_mm * before.axis_P;
    const Vec3 skin_now_P = now.tip_P - *now.depth_mm * now.axis_P;
    area_mm2_ +=
        triangle_mm2(before.tip_P, now.tip_P, skin_now_P) + triangle_mm2(skin_now_P, skin_before_P, before.tip_P);
  }
  void report(const RunEnd&, std::span<MetricValue> values) const override {
    values[0].set(length_mm_);
    values[1].set(time_s_);
    values[2].set(area_mm2_);
    values[3].set(deepest_mm_, deepest_s_);
  }

 private:
  double length_mm_ = 0.0, time_s_ = 0.0, area_mm2_ = 0.0, deepest_mm_ = 0.0;
  std::optional<double> deepest_s_;
};

}  // namespace

MetricGroup tissue_path_metrics() {
  return {kTissuePathValues,
          [](const MetricContext&) -> std::unique_ptr<Metric> { return std::make_unique<TissuePath>(); }};
}

}  // namespace trocar::metrics
