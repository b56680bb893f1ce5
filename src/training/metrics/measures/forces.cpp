// Resistance along the needle, and the tip's motion after punctures.
#include <fmt/format.h>

#include <array>

#include "metrics/measures/groups.h"

namespace trocar::metrics {
namespace {

constexpr std::array kPeakValues{
    MetricDescription{
        "force_peak", "Largest resistance along the needle", "N", Better::kNeither, {Role::kForce}, "paper A, forces"},
};
constexpr std::array kPunctureValues{
    MetricDescription{"puncture_force_peak",
                      "Largest resistance before a puncture",
                      "N",
                      Better::kNeither,
                      {Role::kForce, Role::kEvents},
                      "paper A, pre-puncture force"},
    MetricDescription{"puncture_overshoot",
                      "Largest advance of the tip after a puncture",
                      "mm",
                      Better::kLower,
                      {Role::kEvents, Role::kDepth},
                      "Trocar"},
};
constexpr double kOvershootWithin_s = 0.25;  ///< [assumed] A hand responds to a touch after 0.15 to 0.25 s.
constexpr double kOvershootBack_mm = 0.1;    ///< [assumed] The tip has stopped when it came back by so much.
constexpr std::size_t kMostNotes = 32;

class ForcePeak : public Metric {
 public:
  void step(const Step& step) override {
    if (!step.now.resistance_n || (time_s_ && *step.now.resistance_n <= peak_n_)) return;
    peak_n_ = *step.now.resistance_n;
    time_s_ = step.now.time_s;
  }
  void report(const RunEnd&, std::span<MetricValue> values) const override { values[0].set(peak_n_, time_s_); }

 private:
  double peak_n_ = 0.0;
  std::optional<double> time_s_;
};

class PunctureForces : public Metric {
 public:
  explicit PunctureForces(const MetricContext& context) : names_(context.layer_names) {}

  void step(const Step& step) override {
    const Moment& now = step.now;
    follow_overshoot(step);
    // The force of the tick of a puncture may already be that after it: the peak is the largest since the last one.
    if (now.resistance_n) peak_n_ = std::max(peak_n_.value_or(*now.resistance_n), *now.resistance_n);
    if (!now.events) return;
    for (const telemetry::TickEvent& event : *now.events)
      if (event.kind == telemetry::EventKind::kPuncture) puncture(now, event.id);
  }

  void report(const RunEnd&, std::span<MetricValue> values) const override {
    if (count_ == 0) {
      for (MetricValue& value : values) value.missing = "nothing was punctured";
      return;
    }
    if (largest_s_) values[0].set(largest_n_, largest_s_);
    if (!largest_s_) values[0].missing = "the recording has no force before a puncture";
    values[0].note = forces_text_;
    const bool is_last_larger = open_ && open_->overshoot_mm > overshoot_mm_;
    if (overshoot_s_ || open_)
      values[1].set(is_last_larger ? open_->overshoot_mm : overshoot_mm_,
                    is_last_larger ? open_->time_s : overshoot_s_);
    else
      values[1].missing = "the recording has no depth at a puncture";
    values[1].note = overshoots_text_ + (open_ ? note_of(*open_) : std::string());
  }

 private:
  struct Puncture {
    std::uint8_t id = 0;
    double time_s = 0.0, depth_mm = 0.0, overshoot_mm = 0.0, for_s = 0.0;
    bool is_first = true;  ///< In the note.
  };

  std::string name(std::uint8_t id) const { return id < names_.size() ? names_[id] : fmt::format("#{}", id); }
  std::string note_of(const Puncture& p) const {
    return fmt::format("{}{} {:.1f} mm", p.is_first ? "" : ", ", name(p.id), p.overshoot_mm);
  }

  void puncture(const Moment& now, std::uint8_t id) {
    close();
    if (peak_n_) {
      if (count_ < kMostNotes)
        forces_text_ += fmt::format("{}{} {:.2f} N", forces_text_.empty() ? "" : ", ", name(id), *peak_n_);
      if (!largest_s_ || *peak_n_ > largest_n_) {
        largest_n_ = *peak_n_;
        largest_s_ = now.time_s;
      }
    }
    ++count_;
    peak_n_.reset();
    if (now.depth_mm) open_ = Puncture{id, now.time_s, *now.depth_mm, 0.0, 0.0, overshoots_text_.empty()};
  }
  void follow_overshoot(const Step& step) {
    if (!open_ || !step.now.depth_mm) return;
    open_->for_s += step.dt_s;
    const double beyond_mm = *step.now.depth_mm - open_->depth_mm;
    if (step.before == nullptr || open_->for_s > kOvershootWithin_s ||
        beyond_mm < open_->overshoot_mm - kOvershootBack_mm)
      close();
    else
      open_->overshoot_mm = std::max(open_->overshoot_mm, beyond_mm);
  }
  void close() {
    if (!open_) return;
    if (count_ <= kMostNotes) overshoots_text_ += note_of(*open_);
    if (!overshoot_s_ || open_->overshoot_mm > overshoot_mm_) {
      overshoot_mm_ = open_->overshoot_mm;
      overshoot_s_ = open_->time_s;
    }
    open_.reset();
  }

  std::vector<std::string> names_;
  std::optional<double> peak_n_;  ///< Since the last puncture.
  double largest_n_ = 0.0, overshoot_mm_ = 0.0;
  std::optional<double> largest_s_, overshoot_s_;
  std::optional<Puncture> open_;  ///< The last puncture, while the tip may still advance.
  std::size_t count_ = 0;
  std::string forces_text_, overshoots_text_;
};

}  // namespace

MetricGroup force_metrics() {
  return {kPeakValues, [](const MetricContext&) -> std::unique_ptr<Metric> { return std::make_unique<ForcePeak>(); }};
}

MetricGroup puncture_force_metrics() {
  return {kPunctureValues, [](const MetricContext& context) -> std::unique_ptr<Metric> {
            return std::make_unique<PunctureForces>(context);
          }};
}

}  // namespace trocar::metrics
