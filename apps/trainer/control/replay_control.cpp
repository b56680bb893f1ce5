#include "control/replay_control.h"

#include <QKeyEvent>
#include <algorithm>

#include "attempt/live/attempt_view.h"
#include "control/force_bands.h"
#include "control/path_comparison.h"
#include "control/task_layout.h"
#include "core/files/output_file.h"
#include "pages/work_page.h"
#include "panels/expert_path_list.h"
#include "panels/feedback_panel.h"
#include "panels/hint_list.h"
#include "report/html_report.h"
#include "telemetry/tick_sample.h"
#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "ui_kit/window_language.h"
#include "views/plots/force_plot.h"
#include "views/plots/time_line.h"
#include "views/ultrasound/ultrasound_view.h"
#include "views/xray/xray_view.h"
#include "workspace/shot_display.h"
#include "workspace/workspace.h"

namespace trocar::trainer {
namespace {

using Event = TimeLine::Event;

TimeMark kind_of(const attempt::ReplayMoment& moment) {
  switch (moment.kind) {
    case attempt::ReplayMoment::Kind::kPuncture:
      return TimeMark::kPuncture;
    case attempt::ReplayMoment::Kind::kEnter:
      return TimeMark::kEnter;
    case attempt::ReplayMoment::Kind::kRisk:
      return TimeMark::kRisk;
    case attempt::ReplayMoment::Kind::kFired:
      return TimeMark::kFire;
    case attempt::ReplayMoment::Kind::kWorst:
      return TimeMark::kWorst;
    case attempt::ReplayMoment::Kind::kAction:
    case attempt::ReplayMoment::Kind::kChange:
    case attempt::ReplayMoment::Kind::kInterruption:
      break;
  }
  return TimeMark::kOther;
}

QColor phase_color(telemetry::InsertionPhase phase) {
  switch (phase) {
    case telemetry::InsertionPhase::kLoading:
      return theme().warning;
    case telemetry::InsertionPhase::kInserted:
      return theme().accent;
    case telemetry::InsertionPhase::kRetracting:
      return theme().good;
    case telemetry::InsertionPhase::kOutside:
      break;
  }
  return theme().line;
}

/// Many interruptions in one line, with the longest one; without those that a hand does not notice.
QString interruptions_note(const std::vector<tasks::Interruption>& gaps) {
  const auto length_s = [](const tasks::Interruption& gap) { return gap.to_s - gap.from_s; };
  const auto longest = std::ranges::max_element(gaps, {}, length_s);
  int noticed = 0;
  double whole_s = 0.0;
  for (const tasks::Interruption& gap : gaps) {
    if (length_s(gap) < tasks::kNoticedInterruption_s) continue;
    ++noticed;
    whole_s += length_s(gap);
  }
  return ReplayControl::tr("%1 interruptions, %2 s in total; the longest at %3 s: %4 s, %5")
      .arg(noticed)
      .arg(whole_s, 0, 'f', 1)
      .arg(longest->from_s, 0, 'f', 1)
      .arg(length_s(*longest), 0, 'f', 1)
      .arg(shown(longest->reason));
}

/// Warnings, what was set before the start, and what changed or interrupted the attempt.
QStringList notes_of(const attempt::AttemptReplay& replay, const std::vector<std::string>& warnings) {
  QStringList notes;
  for (const std::string& warning : warnings) notes << shown(warning);
  const auto& parameters = replay.session().parameters;
  if (!parameters.empty() && parameters.front().tick == 0 && !parameters.front().settings.empty()) {
    QStringList settings;
    for (const std::string& setting : parameters.front().settings) settings << to_qt(setting);
    notes << ReplayControl::tr("set before the start: %1").arg(settings.join(QStringLiteral(", ")));
  }
  using Kind = attempt::ReplayMoment::Kind;
  constexpr std::ptrdiff_t kMostListed = 3;
  const auto& moments = replay.moments();
  const auto is_interruption = [](const attempt::ReplayMoment& moment) { return moment.kind == Kind::kInterruption; };
  const auto interruptions = std::ranges::count_if(moments, is_interruption);
  for (const attempt::ReplayMoment& moment : moments)
    if (kind_of(moment) == TimeMark::kOther && (interruptions <= kMostListed || !is_interruption(moment)))
      notes << ReplayControl::tr("at %1 s, %2").arg(moment.time_s, 0, 'f', 1).arg(shown(moment.text));
  if (interruptions > kMostListed) notes << interruptions_note(replay.session().interruptions);
  return notes;
}

QString level_title(const std::string& name) {
  for (const TrainingMode level : {TrainingMode::kGuided, TrainingMode::kAssisted, TrainingMode::kExam})
    if (name == name_of(level)) return ReplayControl::tr(title_of(level));
  return {};
}

}  // namespace

ReplayControl::ReplayControl(attempt::AttemptReplay replay, std::shared_ptr<const cases::OpenCase> open, WorkPage& page,
                             const std::vector<std::string>& warnings)
    : replay_(std::move(replay)),
      open_(std::move(open)),
      page_(page),
      keys_(page, [this](const QKeyEvent& key, const KeyPlace& place) { return take_key(key, place); }) {
  choose_layout(open_->the_case.task, page_.workspace());
  page_.xray().begin_replay(std::make_shared<const attempt::InjectionSteps>(replay_.injections()));
  fill_plot();
  fill_time_line();
  QString worst;
  if (const auto& moment = replay_.worst())
    worst = tr("Worst moment: %1, after %2 s").arg(shown(moment->text)).arg(moment->time_s, 0, 'f', 1);
  page_.feedback().show_outcome(replay_.outcome(), worst);
  page_.feedback().show_level(level_title(replay_.session().info.level));
  page_.feedback().show_cores(replay_.shots());
  page_.feedback().show_notes(notes_of(replay_, warnings));
  page_.workspace().show_help(
      TrainingMode::kGuided);  // after the attempt the expert's path is visible at every level of help
  connect(&page_.feedback(), &FeedbackPanel::worst_requested, this, &ReplayControl::go_to_worst);
  connect(&page_.feedback().hints(), &HintList::moment_chosen, this, &ReplayControl::go_to);
  page_.feedback().expert_paths().show_rows(compare_with_experts(replay_, open_->the_case));
  connect(&page_.feedback().expert_paths(), &ExpertPathList::others_toggled, this, &ReplayControl::show_expert_paths);
  show_expert_paths();
  show_at(replay_.duration_s(), false);
}

ReplayControl::~ReplayControl() {
  page_.workspace().show_expert_paths({open_->the_case.plan.line_P, {}});
}

void ReplayControl::show_expert_paths() {
  const bool has_others = page_.feedback().expert_paths().are_others_shown();
  page_.workspace().show_expert_paths(expert_paths_of(replay_, open_->the_case, has_others));
}

/// Keys of the replay, independent of the focus.
bool ReplayControl::take_key(const QKeyEvent& key, const KeyPlace& place) {
  if (place.is_text || place.is_aside || !page_.time_line().isVisible()) return false;
  const UltrasoundView& ultrasound = page_.ultrasound();
  const bool plays_cine = ultrasound.hasFocus() && ultrasound.is_frozen();
  const auto found = find_action(Scope::kFeedback, key, [&](Action action) {
    return !(action == Action::kPreviousEvent && plays_cine) && !(action == Action::kPlay && place.takes_space);
  });
  if (!found) return false;
  if (found->action == Action::kNextHint) {
    page_.feedback().hints().choose_next();
    return true;
  }
  return page_.time_line().perform(*found);
}

void ReplayControl::fill_plot() {
  ForcePlot& plot = page_.forces();
  plot.clear();
  plot.set_bands(force_bands(*open_));
  plot.set_predicted({});
  plot.set_reference(predicted_curve(*open_));
  std::vector<ForcePoint> points;
  points.reserve(replay_.session().samples.size());
  for (const telemetry::TickSample& sample : replay_.session().samples)
    points.push_back({sample.time_s, sample.depth_mm, telemetry::axial_resistance_n(sample)});
  plot.append(points);
  for (const attempt::ReplayMoment& moment : replay_.moments())
    if (moment.kind == attempt::ReplayMoment::Kind::kPuncture)
      plot.add_event(replay_.at(moment.time_s).depth_mm, moment.time_s, shown(moment.text));
}

void ReplayControl::fill_time_line() {
  TimeLine& line = page_.time_line();
  line.set_duration(replay_.duration_s());
  std::vector<Event> events;
  for (const attempt::ReplayMoment& moment : replay_.moments())
    events.push_back({moment.time_s, shown(moment.text), kind_of(moment)});
  line.set_events(std::move(events));
  std::vector<TimeLine::Phase> phases;
  std::vector<QPointF> curve;
  constexpr std::size_t kEvery = 10;
  const auto& samples = replay_.session().samples;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    if (s % kEvery == 0) curve.emplace_back(samples[s].time_s, telemetry::axial_resistance_n(samples[s]));
    if (s > 0 && samples[s].phase == samples[s - 1].phase) {
      phases.back().to_s = samples[s].time_s;
      continue;
    }
    phases.push_back(
        {samples[s].time_s, samples[s].time_s, shown(to_string(samples[s].phase)), phase_color(samples[s].phase)});
  }
  line.set_phases(std::move(phases));
  line.set_curve(std::move(curve));
  line.set_time(replay_.duration_s());
}

void ReplayControl::advance(double dt_s) {
  page_.time_line().advance(dt_s);
  const double time_s = page_.time_line().time_s();
  // Scrubbing counts as motion: full-quality pictures are drawn when the time stops changing.
  constexpr double kStill_s = 0.3;
  const bool was_moving = still_s_ < kStill_s;
  still_s_ = time_s != shown_s_ || page_.time_line().is_playing() ? 0.0 : still_s_ + dt_s;
  if (time_s != shown_s_ || was_moving != (still_s_ < kStill_s)) show_at(time_s, still_s_ < kStill_s);
}

Pose ReplayControl::transducer_at(double time_s) const {
  return replay_.transducer_at(time_s).value_or(open_->X_PT_start);
}

void ReplayControl::show_at(double time_s, bool is_moving) {
  const telemetry::TickSample& sample = replay_.at(time_s);
  ToolsShown tools;
  tools.motion = replay_.motion_at(time_s);
  tools.shaft_P = replay_.shaft_at(time_s);
  tools.X_PN = telemetry::felt_needle(sample);
  tools.focus_P = sample.depth_mm > 0.0 ? sample.tip_mm : tools.motion.to_now(open_->the_case.plan.line_P.b);
  tools.X_PT = transducer_at(time_s);
  tools.are_moving = is_moving;
  if (const attempt::GunShot* const shot = replay_.shot_at(time_s))
    show_shot(tools, *shot, time_s - shot->time_s, sample.depth_mm);
  page_.workspace().show_tools(std::move(tools));
  show_xray(time_s);
  page_.forces().set_cursor(time_s);
  shown_s_ = time_s;
}

void ReplayControl::show_xray(double time_s) {
  auto moment = replay_.xray_at(time_s);
  std::vector<Vec3> shaft_P;
  if (moment && moment->image_s) {
    if (!moment->is_held()) moment->image_s = page_.xray().pulse_s(*moment->image_s);
    shaft_P = replay_.shaft_at(*moment->image_s);
  }
  const tasks::Action* const wire =
      moment && moment->image_s ? tasks::find_wire(replay_.session().actions, *moment->image_s) : nullptr;
  const Vec3 axis_P = wire != nullptr ? replay_.at(wire->time_s).axis : Vec3::UnitZ();
  const motion::PatientMotion motion = replay_.motion_at(moment && moment->image_s ? *moment->image_s : time_s);
  page_.xray().set_motion(motion);
  std::optional<Segment> wire_P;
  if (wire != nullptr) wire_P.emplace(motion.to_now(wire->tip_A), motion.to_now(wire->tip_A) + wire->amount * axis_P);
  page_.xray().set_wire(wire_P);
  page_.xray().show_moment(moment, std::move(shaft_P));
}

void ReplayControl::go_to_worst() {
  page_.time_line().go_to_worst();
}

void ReplayControl::go_to(double time_s) {
  page_.time_line().set_playing(false);
  page_.time_line().set_time(time_s);
}

Status ReplayControl::save_report(const std::filesystem::path& file) const {
  const storage::Session& session = replay_.session();
  const cases::Case& the_case = open_->the_case;
  report::ReportStory story;
  story.title = the_case.task.title;
  story.needs_image = the_case.task.guidance == tasks::ImagingModality::kUltrasound;
  for (const attempt::AttemptEvent& action :
       attempt::describe_actions(the_case.substances, session, the_case.patient.get()))
    story.actions.push_back({action.time_s, action.depth_mm, action.text});
  story.steps = report::step_times(session, the_case.task, *the_case.patient, the_case.needle, the_case.plan);
  return write_file_atomically(file, report::html_report(session, the_case.patient.get(), story, window_language()));
}

QVariantMap ReplayControl::facts() const {
  QVariantMap facts;
  facts[QStringLiteral("level")] = to_qt(replay_.session().info.level);
  facts[QStringLiteral("score")] = replay_.outcome().score;
  facts[QStringLiteral("not_scored")] = to_qt(replay_.outcome().not_scored);
  facts[QStringLiteral("is_passed")] = replay_.outcome().is_passed;
  facts[QStringLiteral("hint_moments")] =
      static_cast<int>(std::count_if(replay_.outcome().hints.begin(), replay_.outcome().hints.end(),
                                     [](const scoring::Hint& hint) { return hint.at_s.has_value(); }));
  facts[QStringLiteral("target_reached")] = replay_.outcome().target_reached;
  facts[QStringLiteral("expert_paths")] = static_cast<int>(open_->the_case.expert_paths().size());
  facts[QStringLiteral("nearest_path")] = static_cast<int>(replay_.outcome().expert) + 1;
  facts[QStringLiteral("replay_s")] = shown_s_;
  facts[QStringLiteral("duration_s")] = replay_.duration_s();
  facts[QStringLiteral("worst_s")] = replay_.worst() ? replay_.worst()->time_s : 0.0;
  facts[QStringLiteral("probe_from_plan_mm")] = (transducer_at(shown_s_).p() - open_->X_PT_start.p()).norm();
  facts[QStringLiteral("was_cut_off")] = replay_.was_cut_off();
  facts[QStringLiteral("parameter_changes")] = static_cast<int>(replay_.session().parameters.size());
  const XrayView& xray = page_.xray();
  const auto image = xray.frame();
  const tasks::XrayUse use = xray.use();
  facts[QStringLiteral("xray_beam_s")] = use.beam_s;
  facts[QStringLiteral("xray_dose_gycm2")] = use.dose_area_gycm2;
  facts[QStringLiteral("xray_is_on")] = use.is_beam_on;
  facts[QStringLiteral("xray_lao_deg")] = use.lao_deg;
  facts[QStringLiteral("contrast_ml")] = use.contrast_ml;
  facts[QStringLiteral("xray_image_s")] = image ? image->time_s : -1.0;
  facts[QStringLiteral("xray_is_complete")] = xray.is_complete();
  return facts;
}

}  // namespace trocar::trainer
