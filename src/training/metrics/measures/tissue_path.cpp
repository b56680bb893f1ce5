// Travel, time and damage inside the body (Perk Tutor; Johnson 2012, needle distance).
#include <array>

#include "metrics/detail/body.h"
#include "metrics/detail/smooth_path.h"
#include "metrics/measures/groups.h"

namespace trocar::metrics {
namespace {

constexpr std::array kTissuePathValues{
    MetricDescription{"path_in_tissue",
                      "Path length of the tip inside the body",
                      "mm",
                      Better::kLower,
                      {Role::kDepth},
                      "Perk Tutor (Ungi 2012), of means; Johnson 2012, needle distance"},
    MetricDescription{"path_in_tissue_raw",
                      "Path length of the tip inside the body, unfiltered",
                      "mm",
                      Better::kLower,
                      {Role::kDepth},
                      "Perk Tutor (Ungi 2012)"},
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
                      "Perk Tutor (Ungi 2012), of means"},
    MetricDescription{"tissue_damage_raw",
                      "Area swept by the shaft inside the body, unfiltered",
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

/// Swept by the inserted shaft between two positions.
double swept_mm2(const detail::SmoothPath::Point& from, const detail::SmoothPath::Point& to) noexcept {
  if (!(from.depth_mm > 0.0 && to.depth_mm > 0.0)) return 0.0;
  const Vec3 skin_from_P = from.tip_P - from.depth_mm * from.axis_P;
  const Vec3 skin_to_P = to.tip_P - to.depth_mm * to.axis_P;
  return triangle_mm2(from.tip_P, to.tip_P, skin_to_P) + triangle_mm2(skin_to_P, skin_from_P, from.tip_P);
}

/// Sums along a way.
struct TissueSums {
  double length_mm = 0.0, area_mm2 = 0.0;

  void add(const detail::SmoothPath::Point& from, const detail::SmoothPath::Point& to, double inside) noexcept {
    length_mm += inside * (to.tip_P - from.tip_P).norm();
    area_mm2 += swept_mm2(from, to);
  }
};

class TissuePath : public Metric {
 public:
  void step(const Step& step) override {
    const Moment& now = step.now;
    if (now.depth_mm && *now.depth_mm > deepest_mm_) {
      deepest_mm_ = *now.depth_mm;
      deepest_s_ = now.time_s;
    }
    path_.add(step,
              [this](const auto& from, const auto& to) { smooth_.add(from, to, 0.5 * (from.inside + to.inside)); });
    if (step.before == nullptr || !now.depth_mm || !step.before->depth_mm) return;
    const Moment& before = *step.before;
    const double share = detail::share_inside(*before.depth_mm, *now.depth_mm, (now.tip_P - before.tip_P).norm());
    raw_.add({before.tip_P, before.axis_P, *before.depth_mm}, {now.tip_P, now.axis_P, *now.depth_mm}, share);
    time_s_ += share * step.dt_s;
  }
  void report(const RunEnd&, std::span<MetricValue> values) const override {
    TissueSums smooth = smooth_;
    path_.finish([&](const auto& from, const auto& to) { smooth.add(from, to, 0.5 * (from.inside + to.inside)); });
    values[0].set(smooth.length_mm);
    values[1].set(raw_.length_mm);
    values[2].set(time_s_);
    values[3].set(smooth.area_mm2);
    values[4].set(raw_.area_mm2);
    values[5].set(deepest_mm_, deepest_s_);
  }

 private:
  detail::SmoothPath path_;
  TissueSums smooth_, raw_;
  double time_s_ = 0.0, deepest_mm_ = 0.0;
  std::optional<double> deepest_s_;
};

}  // namespace

MetricGroup tissue_path_metrics() {
  return {kTissuePathValues,
          [](const MetricContext&) -> std::unique_ptr<Metric> { return std::make_unique<TissuePath>(); }};
}

}  // namespace trocar::metrics
