#include <array>
#include <numbers>

#include "metrics/detail/uniform_sampler.h"
#include "metrics/measures/groups.h"
#include "volume/sampling.h"

// Use of the ultrasound transducer (Johnson 2012).

namespace trocar::metrics {
namespace {

constexpr std::array kPathValues{
    MetricDescription{"transducer_path",
                      "Path length of the transducer",
                      "mm",
                      Better::kLower,
                      {Role::kTransducer},
                      "Perk Tutor (Ungi 2012), for the transducer, of means"},
    MetricDescription{"transducer_path_raw",
                      "Path length of the transducer, unfiltered",
                      "mm",
                      Better::kLower,
                      {Role::kTransducer},
                      "Perk Tutor (Ungi 2012), for the transducer"},
};
constexpr std::array kContactValues{
    MetricDescription{"probe_time",
                      "Time with the transducer on the skin",
                      "s",
                      Better::kLower,
                      {Role::kTransducer, Role::kContact},
                      "Johnson 2012, probe usage time"},
    MetricDescription{"skin_contacts",
                      "Contacts of the transducer with the skin",
                      "1",
                      Better::kLower,
                      {Role::kTransducer, Role::kContact},
                      "Johnson 2012, number of skin contacts"},
};
constexpr double kContact_n = 0.05;       ///< [assumed] Above the noise of a force sensor.
constexpr double kGel_mm = 1.0;           ///< Gel fills gaps up to this distance (ultrasound/probe/probe_contact.h).
constexpr double kLastingChange_s = 0.2;  ///< [assumed] A shorter change neither ends nor begins a contact.

class TransducerPath : public Metric {
 public:
  void step(const Step& step) override {
    if (!step.now.X_PT) return;
    Moment now;  // the transducer in the place of the needle
    now.tip_P = step.now.X_PT->p();
    if (step.before == nullptr || !step.before->X_PT) return add({now});
    Moment before;
    before.tip_P = step.before->X_PT->p();
    raw_mm_ += (now.tip_P - before.tip_P).norm();
    add({now, &before, step.dt_s});
  }
  void report(const RunEnd&, std::span<MetricValue> values) const override {
    double rest_mm = 0.0;
    path_.finish([&](const auto& from, const auto& to) { rest_mm = (to.tip_P - from.tip_P).norm(); });
    values[0].set(length_mm_ + rest_mm);
    values[1].set(raw_mm_);
  }

 private:
  void add(const Step& step) {
    path_.add(step, [this](const auto& from, const auto& to) { length_mm_ += (to.tip_P - from.tip_P).norm(); });
  }

  detail::SmoothPath path_;
  double length_mm_ = 0.0, raw_mm_ = 0.0;
};

class TransducerContact : public Metric {
 public:
  explicit TransducerContact(const MetricContext& context) : patient_(context.patient) {}

  void step(const Step& step) override {
    if (!step.now.X_PT) return;
    const bool touches = is_touching(step.now);
    if (step.before != nullptr && was_touching_) time_s_ += step.dt_s;
    was_touching_ = touches;
    if (is_first_) {
      is_first_ = false;
      is_counted_ = touches;
      count_ = touches ? 1.0 : 0.0;
      return;
    }
    other_s_ = touches != is_counted_ ? other_s_ + step.dt_s : 0.0;
    if (other_s_ < kLastingChange_s) return;
    is_counted_ = touches;
    other_s_ = 0.0;
    if (touches) ++count_;
  }
  void report(const RunEnd&, std::span<MetricValue> values) const override {
    values[0].set(time_s_);
    values[1].set(count_);
  }

 private:
  bool is_touching(const Moment& now) const noexcept {
    if (now.contact_n) return *now.contact_n > kContact_n;
    return patient_ != nullptr && !patient_->skin_distance_mm.empty() &&
           volume::sample_linear(patient_->skin_distance_mm, now.X_PT->p()) <= kGel_mm;
  }

  const anatomy::VirtualPatient* patient_;
  bool is_first_ = true, was_touching_ = false, is_counted_ = false;
  double other_s_ = 0.0, time_s_ = 0.0, count_ = 0.0;
};

}  // namespace

MetricGroup transducer_metrics() {
  return {kPathValues,
          [](const MetricContext&) -> std::unique_ptr<Metric> { return std::make_unique<TransducerPath>(); }};
}

MetricGroup contact_metrics() {
  return {kContactValues, [](const MetricContext& context) -> std::unique_ptr<Metric> {
            return std::make_unique<TransducerContact>(context);
          }};
}

}  // namespace trocar::metrics

// Needle and ultrasound image plane.

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
