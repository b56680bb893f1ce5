// Distances between the tip's way inside the body and the nearest expert path.
#include <array>

#include "metrics/curve_distances.h"
#include "metrics/detail/curve.h"
#include "metrics/measures/groups.h"

namespace trocar::metrics {
namespace {

constexpr std::array kCurveValues{
    MetricDescription{"frechet_distance",
                      "Fréchet distance of the tip's path from the expert path",
                      "mm",
                      Better::kLower,
                      {Role::kExpert, Role::kDepth},
                      "Eiter, Mannila 1994"},
    MetricDescription{"hausdorff_distance",
                      "Hausdorff distance of the tip's path from the expert path",
                      "mm",
                      Better::kLower,
                      {Role::kExpert, Role::kDepth},
                      "Hausdorff 1914"},
    MetricDescription{"dtw_distance",
                      "Dynamic time warping distance of the tip's path from the expert path",
                      "mm",
                      Better::kLower,
                      {Role::kExpert, Role::kDepth},
                      "Sakoe, Chiba 1978"},
};
constexpr double kOut_mm = 0.0;

/// Keeps the tip's way of the insertion that contains the end, and of the present one.
class CurveDistance : public Metric {
 public:
  explicit CurveDistance(const MetricContext& context) : paths_(context.expert_paths), end_s_(context.end_s) {}

  void step(const Step& step) override {
    const Moment& now = step.now;
    if (!now.depth_mm) return;
    if (*now.depth_mm <= kOut_mm) {
      was_inside_ = false;
      return;
    }
    if (!was_inside_) begin();
    was_inside_ = true;
    present_.add(now.tip_A(), now.time_s);
    const bool is_end = end_s_ && now.time_s >= *end_s_;
    if (is_over_ || (!is_end && *now.depth_mm <= deepest_mm_)) return;
    deepest_mm_ = *now.depth_mm;
    is_end_in_present_ = true;
    is_over_ = is_end;
  }

  void report(const RunEnd& end, std::span<MetricValue> values) const override {
    const detail::ThinPath& way = is_end_in_present_ ? present_ : kept_;
    if (!end.inserted_P || !end.expert || way.points().empty()) {
      for (MetricValue& value : values) value.missing = "the needle did not enter the body";
      return;
    }
    std::vector<Vec3> points_P;
    for (const detail::ThinPath::Point& point : way.points())
      if (point.time_s <= end.moment->time_s) points_P.push_back(point.p_P);
    points_P.push_back(end.moment->tip_A());
    const CurveDistances distances = curve_distances(points_P, paths_[*end.expert].line_P);
    values[0].set(distances.frechet_mm);
    values[1].set(distances.hausdorff_mm);
    values[2].set(distances.dtw_mm);
  }

 private:
  void begin() {
    if (is_end_in_present_) std::swap(kept_, present_);
    present_.clear();
    is_end_in_present_ = false;
  }

  std::vector<ExpertPath> paths_;
  std::optional<double> end_s_;
  detail::ThinPath kept_, present_;
  bool is_end_in_present_ = false, was_inside_ = false, is_over_ = false;
  double deepest_mm_ = 0.0;
};

}  // namespace

MetricGroup curve_distance_metrics() {
  return {kCurveValues, [](const MetricContext& context) -> std::unique_ptr<Metric> {
            return std::make_unique<CurveDistance>(context);
          }};
}

}  // namespace trocar::metrics
