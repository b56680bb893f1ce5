// Use of the ultrasound transducer (Johnson 2012).
#include <array>

#include "metrics/detail/smooth_path.h"
#include "metrics/measures/groups.h"
#include "volume/sampling.h"

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
