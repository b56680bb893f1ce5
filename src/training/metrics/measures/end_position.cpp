// Final position of the needle against the expert paths (paper B, evaluation component).
#include <array>
#include <numbers>

#include "metrics/detail/body.h"
#include "metrics/measures/groups.h"

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
      values[2].set(angle_between_rad(last.axis_A(), path.line_P.b - path.line_P.a) * 180.0 / std::numbers::pi,
                    last.time_s);
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
