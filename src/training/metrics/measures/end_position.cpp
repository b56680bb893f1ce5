#include <array>

#include "metrics/curve_distances.h"
#include "metrics/detail/body.h"
#include "metrics/measures/groups.h"

// Final position of the needle against the expert paths (paper B, evaluation component).

namespace trocar::metrics {
namespace {

constexpr const char* kPaperB = "paper B, evaluation component";
constexpr std::array kEndValues{
    MetricDescription{"target_distance",
                      "Distance of the tip from the target at the end",
                      "mm",
                      Better::kLower,
                      {Role::kExpert},
                      kPaperB},
    MetricDescription{"entry_offset",
                      "Distance of the entry from the expert's entry",
                      "mm",
                      Better::kLower,
                      {Role::kExpert, Role::kDepth},
                      kPaperB},
    MetricDescription{
        "path_angle", "Angle between the needle and the expert path", "deg", Better::kLower, {Role::kExpert}, kPaperB},
    MetricDescription{"path_distance_mean",
                      "Mean distance of the inserted needle from the expert path",
                      "mm",
                      Better::kLower,
                      {Role::kExpert, Role::kDepth},
                      kPaperB},
    MetricDescription{"path_distance_max",
                      "Largest distance of the inserted needle from the expert path",
                      "mm",
                      Better::kLower,
                      {Role::kExpert, Role::kDepth},
                      kPaperB},
    MetricDescription{
        "expert_path", "Number of the nearest expert path", "1", Better::kNeither, {Role::kExpert}, "Trocar"},
    MetricDescription{"targeting",
                      "Smallest distance of the tip from the target",
                      "mm",
                      Better::kLower,
                      {Role::kExpert},
                      "Johnson 2012 (formula not in the abstract)"},
};

class EndPosition : public Metric {
 public:
  explicit EndPosition(const MetricContext& context) : paths_(context.expert_paths), nearest_(paths_.size()) {}

  void step(const Step& step) override {
    for (std::size_t n = 0; n < paths_.size(); ++n) {
      const double apart_mm = (step.now.tip_A() - paths_[n].line_P.b).norm();
      if (nearest_[n].time_s && apart_mm >= nearest_[n].distance_mm) continue;
      nearest_[n] = {apart_mm, step.now.time_s};
    }
  }

  void report(const RunEnd& end, std::span<MetricValue> values) const override {
    if (!end.moment || !end.expert) {
      for (MetricValue& value : values) value.missing = "the needle has no end position: it was never in the body";
      return;
    }
    const ExpertPath& path = paths_[*end.expert];
    const Moment& last = *end.moment;
    values[0].set((last.tip_A() - path.line_P.b).norm(), last.time_s);
    if (end.entry_P)
      values[1].set((*end.entry_P - path.line_P.a).norm());
    else
      values[1].missing = "the needle did not enter the body";
    if (path.line_P.length_mm() > 0.0)
      values[2].set(degrees(angle_between_rad(last.axis_A(), path.line_P.b - path.line_P.a)), last.time_s);
    else
      values[2].missing = "the expert path has no length";
    if (end.inserted_P) {
      const detail::PieceDistance apart = detail::piece_distance(*end.inserted_P, path.line_P);
      values[3].set(apart.mean_mm, last.time_s);
      values[4].set(apart.largest_mm, last.time_s);
    } else {
      values[3].missing = values[4].missing = "no part of the needle is in the body at its end position";
    }
    values[5].set(static_cast<double>(*end.expert + 1));
    values[5].note = path.name;
    values[6].set(nearest_[*end.expert].distance_mm, nearest_[*end.expert].time_s);
  }

 private:
  struct Nearest {
    double distance_mm = 0.0;
    std::optional<double> time_s;
  };
  std::vector<ExpertPath> paths_;
  std::vector<Nearest> nearest_;  ///< By expert path.
};

}  // namespace

MetricGroup end_position_metrics() {
  return {kEndValues, [](const MetricContext& context) -> std::unique_ptr<Metric> {
            return std::make_unique<EndPosition>(context);
          }};
}

}  // namespace trocar::metrics

// Distances between the tip's way inside the body and the nearest expert path.

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
