#include "attempt/record/attempt_replay.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "anatomy/structure_words.h"
#include "attempt/guide/needle_view.h"
#include "attempt/live/attempt_view.h"
#include "attempt/record/score_session.h"
#include "attempt/record/session_case.h"
#include "geometry/shapes.h"

namespace trocar::attempt {
namespace {

/// The label of an event, by its id in the session.
const anatomy::Label* find_entered(const cases::OpenCase& open, const telemetry::TickEvent& event) {
  if (event.kind != telemetry::EventKind::kEnter) return nullptr;
  for (const anatomy::Label& label : open.the_case.patient->label_table.labels)
    if (label.id == event.id) return &label;
  return nullptr;
}

}  // namespace

Result<AttemptReplay> AttemptReplay::load(const std::filesystem::path& path,
                                          std::shared_ptr<const cases::OpenCase> open) {
  TROCAR_TRY(storage::Session session, storage::load_session(path));
  Result<AttemptReplay> replay = of(std::move(session), std::move(open));
  if (!replay) replay.error().where = path.string();
  return replay;
}

Result<AttemptReplay> AttemptReplay::of(storage::Session session, std::shared_ptr<const cases::OpenCase> open) {
  if (session.samples.empty()) return fail("the attempt ended before its first tick", {}, "start another one");
  if (session.info.patient_hash != open->the_case.patient->content_hash)
    return fail("the session is of another patient than the case", {}, "open that patient first");
  TROCAR_TRY_STATUS(check_motion(session, *open->the_case.patient));
  const bool was_cut_off = !session.outcome.has_value();
  if (was_cut_off) {
    session.outcome = score_session(open->the_case, session);
  }
  return AttemptReplay(std::move(session), std::move(open), was_cut_off);
}

AttemptReplay::AttemptReplay(storage::Session session, std::shared_ptr<const cases::OpenCase> open, bool was_cut_off)
    : session_(std::move(session)),
      open_(std::move(open)),
      motion_(session_, *open_->the_case.patient),
      was_cut_off_(was_cut_off) {
  for (const std::size_t fired : session_.shots)
    shots_.push_back(make_gun_shot(open_->the_case, session_.samples[fired]));
  find_moments();
  find_worst();
  if (worst_) moments_.push_back(*worst_);
  std::stable_sort(moments_.begin(), moments_.end(),
                   [](const ReplayMoment& a, const ReplayMoment& b) { return a.time_s < b.time_s; });
}

const GunShot* AttemptReplay::shot_at(double time_s) const noexcept {
  const GunShot* last = nullptr;
  for (const GunShot& shot : shots_)
    if (shot.time_s <= time_s) last = &shot;
  for (const tasks::Action& action : session_.actions)
    if (last != nullptr && action.kind == tasks::ActionKind::kLoad && action.time_s > last->time_s &&
        action.time_s <= time_s)
      return nullptr;
  return last;
}

const telemetry::TickSample& AttemptReplay::at(double time_s) const noexcept {
  const auto& samples = session_.samples;
  const auto next = std::upper_bound(samples.begin(), samples.end(), time_s,
                                     [](double t, const telemetry::TickSample& sample) { return t < sample.time_s; });
  return next == samples.begin() ? samples.front() : *(next - 1);
}

std::vector<Vec3> AttemptReplay::shaft_at(double time_s) const {
  const auto& shapes = session_.shapes;
  const auto next = std::ranges::upper_bound(shapes, time_s, {}, &telemetry::NeedleShape::time_s);
  const telemetry::NeedleShape& shape = next == shapes.begin() ? telemetry::NeedleShape{} : *(next - 1);
  return needle_shaft(at(time_s), shape, open_->the_case.needle.length_mm);
}

std::optional<Pose> AttemptReplay::transducer_at(double time_s) const noexcept {
  const auto& moments = session_.transducer;
  if (moments.empty()) return std::nullopt;
  const auto next =
      std::upper_bound(moments.begin(), moments.end(), time_s,
                       [](double t, const storage::TransducerSample& sample) { return t < sample.time_s; });
  if (next == moments.begin()) return moments.front().X_PT;
  const storage::TransducerSample& before = *(next - 1);
  if (next == moments.end() || next->time_s - before.time_s > kTransducerGap_s) return before.X_PT;
  const double share = (time_s - before.time_s) / (next->time_s - before.time_s);
  const Eigen::Quaterniond from(before.X_PT.R()), to(next->X_PT.R());
  return Pose(from.slerp(share, to).toRotationMatrix(), before.X_PT.p() + share * (next->X_PT.p() - before.X_PT.p()));
}

InjectionSteps AttemptReplay::injections() const {
  return injection_steps(session_.xray, [this](double time_s) { return at(time_s).rest_tip_mm; });
}

void AttemptReplay::find_moments() {
  using Kind = ReplayMoment::Kind;
  for (const telemetry::TickSample& sample : session_.samples) {
    for (const telemetry::TickEvent& event : sample.events) {
      if (event.kind == telemetry::EventKind::kPuncture) {
        const std::string text = storage::event_text(session_.info, event);
        moments_.push_back(
            {sample.time_s, Kind::kPuncture, "through the " + anatomy::layer_words(text.substr(text.find(':') + 1))});
      }
      const anatomy::Label* label = find_entered(*open_, event);
      if (label == nullptr) continue;
      moments_.push_back({sample.time_s, Kind::kEnter, "into the " + anatomy::structure_words(label->name)});
    }
  }
  const cases::Case& the_case = open_->the_case;
  harms_ = metrics::find_harms(the_case.task, *the_case.patient, the_case.needle, session_.samples, session_.shots,
                               session_.interruptions, session_.actions);
  for (const metrics::HarmEvent& harm : harms_)
    moments_.push_back({harm.begin_s, Kind::kRisk, metrics::harm_words(harm)});
  for (const storage::SessionParameters& change : session_.parameters)
    if (change.tick > 0)
      moments_.push_back(
          {change.time_s, Kind::kChange, fmt::format("parameters: {}", fmt::join(change.settings, ", "))});
  for (AttemptEvent& action : describe_actions(the_case.substances, session_, the_case.patient.get()))
    moments_.push_back({action.time_s, Kind::kAction, std::move(action.text)});
  for (const tasks::Interruption& gap : session_.interruptions)
    if (gap.to_s - gap.from_s >= tasks::kNoticedInterruption_s)
      moments_.push_back({gap.to_s, Kind::kInterruption,
                          fmt::format("interrupted for {:.1f} s: {}", gap.to_s - gap.from_s, gap.reason)});
  for (const GunShot& shot : shots_) moments_.push_back({shot.time_s, Kind::kFired, shot_words(shot)});
}

/// The gravest harm comes first, where the needle was deepest in it; then the largest distance of the needle from the
/// path in the body, if it is worth saying; then the largest force. A needle without contact has no worst moment.
void AttemptReplay::find_worst() {
  if (!harms_.empty()) {
    worst_ = {harms_.front().worst_s, ReplayMoment::Kind::kWorst, metrics::harm_words(harms_.front())};
    return;
  }
  constexpr double kInside_mm = 1.0;
  const Segment& plan_P = session_.info.plan_P.line_P;
  const Vec3 direction_P = plan_P.direction();
  double farthest_mm = -1.0;
  double farthest_s = 0.0;
  for (const telemetry::TickSample& sample : session_.samples) {
    if (sample.depth_mm < kInside_mm) continue;
    const double beside_mm = distance_to_line_mm(plan_P.a, direction_P, sample.rest_tip_mm);
    if (beside_mm <= farthest_mm) continue;
    farthest_mm = beside_mm;
    farthest_s = sample.time_s;
  }
  constexpr double kWorthSaying_mm = 1.0;  // [assumed] a nearer needle follows the path
  if (farthest_mm >= 0.0 && farthest_mm < kWorthSaying_mm) return;
  if (farthest_mm >= 0.0) {
    worst_ = {farthest_s, ReplayMoment::Kind::kWorst, fmt::format("{:.1f} mm from the planned path", farthest_mm)};
    return;
  }
  constexpr double kFelt_n = 0.05;  // rounds to 0.1 N
  const auto strongest = std::max_element(session_.samples.begin(), session_.samples.end(),
                                          [](const telemetry::TickSample& a, const telemetry::TickSample& b) {
                                            return telemetry::axial_resistance_n(a) < telemetry::axial_resistance_n(b);
                                          });
  if (telemetry::axial_resistance_n(*strongest) < kFelt_n) return;
  worst_ = {strongest->time_s, ReplayMoment::Kind::kWorst,
            fmt::format("{:.1f} N without piercing the skin", telemetry::axial_resistance_n(*strongest))};
}

}  // namespace trocar::attempt
