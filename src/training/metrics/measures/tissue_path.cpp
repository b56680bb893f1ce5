#include <algorithm>
#include <array>
#include <bitset>
#include <limits>

#include "metrics/detail/body.h"
#include "metrics/detail/uniform_sampler.h"
#include "metrics/harm_watch.h"
#include "metrics/measures/groups.h"
#include "tasks/fit_to_patient.h"
#include "volume/sampling.h"

// Travel, time and damage inside the body (Perk Tutor; Johnson 2012, needle distance).

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

// Structures that the tip passed (paper B, evaluation component).

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

// Target and risk structures of the task (paper B; Johnson 2012, no-go areas).

namespace trocar::metrics {
namespace {

constexpr std::array kRiskValues{
    MetricDescription{"end_in_target",
                      "End position in the target (1) or not (0)",
                      "1",
                      Better::kHigher,
                      {Role::kTask, Role::kPatient, Role::kDepth},
                      "paper B, evaluation component"},
    MetricDescription{"risk_structures",
                      "Risk structures touched by tip or shaft",
                      "1",
                      Better::kLower,
                      {Role::kTask, Role::kPatient, Role::kDepth},
                      "paper B, evaluation component"},
    MetricDescription{"no_go_touches",
                      "Contacts with risk structures",
                      "1",
                      Better::kLower,
                      {Role::kTask, Role::kPatient, Role::kDepth},
                      "Johnson 2012, no-go area touched"},
    MetricDescription{"no_go_time",
                      "Time in risk structures",
                      "s",
                      Better::kLower,
                      {Role::kTask, Role::kPatient, Role::kDepth},
                      "Johnson 2012, total time in no-go area"},
    MetricDescription{"complications",
                      "Structures with major or critical harm",
                      "1",
                      Better::kLower,
                      {Role::kTask, Role::kPatient, Role::kDepth},
                      "PMC11583760; classes of Sacks 2003"},
};
constexpr double kShaftStep_mm = 1.0;  // distance of tested points of the shaft
constexpr double kMoved_mm = 0.25;     // the contacts of a needle that moved less are those found before
constexpr double kLongestTested_mm = 500.0;
constexpr double kTouchesApart_s = 0.2;  ///< [assumed] Contacts with a shorter pause count as one.

class Risks : public Metric {
 public:
  explicit Risks(const MetricContext& context)
      : task_(*context.task),
        patient_(*context.patient),
        labels_(task_, patient_),
        needle_(context.needle),
        paths_(context.expert_paths),
        shots_s_(context.shots_s),
        watch_(task_, patient_, needle_.value_or(tasks::Needle())) {
    last_s_.fill(-std::numeric_limits<double>::infinity());
  }

  void step(const Step& step) override {
    watch_.step(step.now);
    for (; shot_ < shots_s_.size() && shots_s_[shot_] <= step.now.time_s; ++shot_) watch_.fire(step.now);
    if (!step.is_inside()) {
      contacts_.reset();
      touched_bone_ = 0;
      is_checked_ = false;
      return;
    }
    if (step.before != nullptr && (contacts_.any() || touched_bone_)) time_s_ += step.dt_s;
    const std::uint8_t ahead = detail::label_ahead(patient_, step.now);  // the needle only touches bone
    touched_bone_ = labels_.is_bone(ahead) && labels_.harm(ahead) > tasks::Harm::kNone ? ahead : std::uint8_t{0};
    if (!has_moved(step.now)) {
      mark(step);
      return;
    }
    contacts_.reset();
    const double length_mm = std::min(*step.now.depth_mm, kLongestTested_mm);
    for (double back_mm = 0.0; back_mm < length_mm; back_mm += kShaftStep_mm)
      test(step.now.tip_A() - (step.now.pressed_mm + back_mm) * step.now.axis_A());
    const std::bitset<256> now = contacts_;
    if (is_checked_ && step.before != nullptr) test_way(tip_P_, step.now.tip_A());
    tip_P_ = step.now.tip_A();
    skin_P_ = tip_P_ - length_mm * step.now.axis_A();
    is_checked_ = true;
    mark(step);
    contacts_ = now;  // the tip has left the structures on its way
  }

  void report(const RunEnd& end, std::span<MetricValue> values) const override {
    if (end.moment && end.inserted_P)
      values[0].set(is_target_reached(end) ? 1.0 : 0.0, end.moment->time_s);
    else
      values[0].set(0.0);
    values[1].set(static_cast<double>(order_.size()), first_s_);
    for (const std::uint8_t id : order_) {
      const anatomy::Label* label = patient_.label_table.find(id);
      values[1].note += (values[1].note.empty() ? "" : ", ") + (label != nullptr ? label->name : std::to_string(id));
    }
    values[2].set(touches_, first_s_);
    values[3].set(time_s_, first_s_);
    report_complications(values[4]);
  }

 private:
  void report_complications(MetricValue& value) const {
    std::vector<HarmEvent> harms = watch_.events();
    std::erase_if(harms, [](const HarmEvent& event) { return event.grade < tasks::Harm::kMajor; });
    std::stable_sort(harms.begin(), harms.end(), is_graver);
    value.set(static_cast<double>(harms.size()),
              harms.empty() ? std::optional<double>() : std::optional(harms.front().worst_s));
    for (const HarmEvent& event : harms) value.note += (value.note.empty() ? "" : ", ") + harm_words(event);
  }
  bool has_moved(const Moment& now) const noexcept {
    if (!is_checked_) return true;
    const Vec3 skin_P = now.tip_A() - std::min(*now.depth_mm, kLongestTested_mm) * now.axis_A();
    return (now.tip_A() - tip_P_).norm() > kMoved_mm || (skin_P - skin_P_).norm() > kMoved_mm;
  }
  void test(const Vec3& p_P) {
    const std::uint8_t id = volume::sample_nearest<std::uint8_t>(patient_.labels, p_P, 0);
    if (labels_.harm(id) > tasks::Harm::kNone) contacts_.set(id);
  }
  void test_way(const Vec3& from_P, const Vec3& to_P) {
    const double length_mm = std::min((to_P - from_P).norm(), kLongestTested_mm);
    const int steps = static_cast<int>(length_mm / detail::kTestedEvery_mm) + 1;
    for (int n = 1; n < steps; ++n) test(from_P + (to_P - from_P) * n / steps);
  }
  /// Counts the contacts of this moment that did not exist just before.
  void mark(const Step& step) {
    if (contacts_.none() && !touched_bone_) return;
    for (std::size_t id = 1; id < contacts_.size(); ++id) {
      if (!contacts_[id] && id != touched_bone_) continue;
      if (last_s_[id] < 0.0) order_.push_back(static_cast<std::uint8_t>(id));
      if (step.active_s - last_s_[id] > kTouchesApart_s) ++touches_;
      last_s_[id] = step.active_s;
      if (!first_s_) first_s_ = step.now.time_s;
    }
  }
  /// The tip, its wall pierced, or the notch's middle after the shot of a biopsy needle is in the target. Where the
  /// target is a place (a point of the task, healthy organ): within the tolerance of the nearest expert path's end, or
  /// in the organ if there is no expert path.
  bool is_target_reached(const RunEnd& end) const {
    const Moment& last = *end.moment;
    const bool is_place = labels_.is_parenchymal() || task_.target_P;
    if (is_place && end.expert)
      return (last.tip_A() - paths_[*end.expert].line_P.b).norm() <= task_.target_tolerance_mm;
    const bool is_biopsy = needle_ && needle_->is_biopsy;
    const double beyond_mm = is_biopsy ? needle_->notch_middle_mm() : -last.pressed_mm;
    const Vec3 reach_P = last.tip_A() + beyond_mm * last.axis_A();
    return labels_.part(volume::sample_nearest<std::uint8_t>(patient_.labels, reach_P, 0)) ==
           tasks::TaskLabels::Part::kTarget;
  }

  const tasks::Task& task_;
  const anatomy::VirtualPatient& patient_;
  tasks::TaskLabels labels_;
  std::optional<tasks::Needle> needle_;
  std::vector<ExpertPath> paths_;
  std::vector<double> shots_s_;
  std::size_t shot_ = 0;  ///< The next one.
  HarmWatch watch_;
  std::bitset<256> contacts_;      ///< Risk structures that the needle is in now, by label.
  std::uint8_t touched_bone_ = 0;  ///< Label of the bone that the tip touches now.
  Vec3 tip_P_ = Vec3::Zero(), skin_P_ = Vec3::Zero();
  bool is_checked_ = false;
  std::array<double, 256> last_s_{};  ///< Active time of the last contact, by label.
  std::vector<std::uint8_t> order_;
  double touches_ = 0.0, time_s_ = 0.0;
  std::optional<double> first_s_;
};

}  // namespace

MetricGroup risk_metrics() {
  return {kRiskValues,
          [](const MetricContext& context) -> std::unique_ptr<Metric> { return std::make_unique<Risks>(context); }};
}

}  // namespace trocar::metrics
