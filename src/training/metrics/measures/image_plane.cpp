// Needle and ultrasound image plane.
#include <array>
#include <numbers>

#include "metrics/detail/time_median.h"
#include "metrics/measures/groups.h"

namespace trocar::metrics {
namespace {

constexpr std::array kPlaneValues{
    MetricDescription{"plane_angle",
                      "Median angle between needle and image plane",
                      "deg",
                      Better::kLower,
                      {Role::kTransducer, Role::kDepth},
                      "Trocar"},
    MetricDescription{"plane_offset",
                      "Median distance of the tip from the image plane",
                      "mm",
                      Better::kLower,
                      {Role::kTransducer, Role::kDepth},
                      "Trocar"},
    MetricDescription{"plane_angle_end",
                      "Angle between needle and image plane at the end",
                      "deg",
                      Better::kLower,
                      {Role::kTransducer, Role::kDepth},
                      "Trocar"},
    MetricDescription{"plane_offset_end",
                      "Distance of the tip from the image plane at the end",
                      "mm",
                      Better::kLower,
                      {Role::kTransducer, Role::kDepth},
                      "Trocar"},
};
constexpr std::array kVisibilityValues{
    MetricDescription{"needle_in_beam",
                      "Mean share of the inserted needle in the beam",
                      "%",
                      Better::kHigher,
                      {Role::kTransducer, Role::kDepth, Role::kPlane},
                      "Johnson 2012, mean needle length in beam"},
    MetricDescription{"tip_visible",
                      "Share of the advance with the tip in the image",
                      "%",
                      Better::kHigher,
                      {Role::kTransducer, Role::kDepth, Role::kPlane},
                      "Trocar"},
};
constexpr double kAngleBin_deg = 0.05;
constexpr double kLargestOffset_mm = 200.0, kOffsetBin_mm = 0.05;
constexpr double kEvery_s = 0.01;  // the transducer is recorded 100 times a second
constexpr double kShaftPiece_mm = 1.0;
constexpr double kLongestShaft_mm = 400.0;

/// Angle (deg) between a needle and the plane, 0..90; distance (mm) of its tip from the plane.
struct PlaneRelation {
  double angle_deg = 0.0, offset_mm = 0.0;
};
PlaneRelation relate(const Moment& moment) noexcept {
  const Vec3 normal_P = moment.X_PT->R().col(2);
  return {std::asin(std::min(1.0, std::abs(normal_P.dot(moment.axis_P)))) * 180.0 / std::numbers::pi,
          std::abs(normal_P.dot(moment.tip_P - moment.X_PT->p()))};
}

class NeedlePlane : public Metric {
 public:
  void step(const Step& step) override {
    if (!step.is_inside() || !step.now.X_PT || step.before == nullptr) return;
    const PlaneRelation relation = relate(step.now);
    angle_deg_.add(relation.angle_deg, step.dt_s);
    offset_mm_.add(relation.offset_mm, step.dt_s);
  }
  void report(const RunEnd& end, std::span<MetricValue> values) const override {
    const auto set = [](MetricValue& value, const std::optional<double>& median) {
      if (median)
        value.set(*median);
      else
        value.missing = "the needle was not in the body while the transducer was recorded";
    };
    set(values[0], angle_deg_.median());
    set(values[1], offset_mm_.median());
    if (!end.moment || !end.moment->X_PT || !end.inserted_P) {
      values[2].missing = values[3].missing = "no transducer, or no needle in the body, at the end position";
      return;
    }
    const PlaneRelation relation = relate(*end.moment);
    values[2].set(relation.angle_deg, end.moment->time_s);
    values[3].set(relation.offset_mm, end.moment->time_s);
  }

 private:
  detail::TimeMedian angle_deg_{90.0, kAngleBin_deg}, offset_mm_{kLargestOffset_mm, kOffsetBin_mm};
};

class Visibility : public Metric {
 public:
  explicit Visibility(const MetricContext& context) : plane_(*context.plane) {}

  void step(const Step& step) override {
    if (!step.is_inside()) {
      deepest_mm_ = 0.0;
      waited_s_ = 0.0;
      return;
    }
    if (!step.now.X_PT) return;
    const Pose X_TP = step.now.X_PT->inverse();
    const double advance_mm = *step.now.depth_mm - deepest_mm_;
    if (advance_mm > 0.0) {
      deepest_mm_ = *step.now.depth_mm;
      advance_mm_ += advance_mm;
      if (plane_.is_visible(X_TP * step.now.tip_P)) visible_mm_ += advance_mm;
    }
    waited_s_ += step.dt_s;
    if (waited_s_ < kEvery_s) return;
    time_s_ += waited_s_;
    share_s_ += waited_s_ * share_in_beam(step.now, X_TP);
    waited_s_ = 0.0;
  }
  void report(const RunEnd&, std::span<MetricValue> values) const override {
    if (time_s_ > 0.0)
      values[0].set(100.0 * share_s_ / time_s_);
    else
      values[0].missing = "the needle was not in the body while the transducer was recorded";
    if (advance_mm_ > 0.0)
      values[1].set(100.0 * visible_mm_ / advance_mm_);
    else
      values[1].missing = "the needle did not advance in the body while the transducer was recorded";
  }

 private:
  double share_in_beam(const Moment& now, const Pose& X_TP) const noexcept {
    const double length_mm = std::min(*now.depth_mm, kLongestShaft_mm);
    const int pieces = static_cast<int>(length_mm / kShaftPiece_mm) + 1;
    const Vec3 tip_T = X_TP * now.tip_P, step_T = X_TP.R() * now.axis_P * (length_mm / pieces);
    int seen = 0;
    for (int n = 0; n < pieces; ++n) seen += plane_.is_visible(tip_T - (n + 0.5) * step_T) ? 1 : 0;
    return static_cast<double>(seen) / pieces;
  }

  ImagePlane plane_;
  double deepest_mm_ = 0.0;  ///< In the present insertion.
  double advance_mm_ = 0.0, visible_mm_ = 0.0;
  double waited_s_ = 0.0, time_s_ = 0.0, share_s_ = 0.0;
};

}  // namespace

MetricGroup plane_metrics() {
  return {kPlaneValues,
          [](const MetricContext&) -> std::unique_ptr<Metric> { return std::make_unique<NeedlePlane>(); }};
}

MetricGroup visibility_metrics() {
  return {kVisibilityValues, [](const MetricContext& context) -> std::unique_ptr<Metric> {
            return std::make_unique<Visibility>(context);
          }};
}

}  // namespace trocar::metrics
