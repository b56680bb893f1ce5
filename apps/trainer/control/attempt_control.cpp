#include "control/attempt_control.h"

#include <signal.h>

#include <QKeyEvent>
#include <algorithm>

#include "anatomy/structure_words.h"
#include "attempt/guide/needle_view.h"
#include "control/attempt_words.h"
#include "control/force_bands.h"
#include "control/task_layout.h"
#include "pages/work_page.h"
#include "panels/puncture_panel.h"
#include "panels/step_list.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"
#include "views/patient/patient_view.h"
#include "views/plots/force_plot.h"
#include "views/ultrasound/ultrasound_view.h"
#include "views/xray/xray_view.h"
#include "workspace/shot_display.h"
#include "workspace/workspace.h"

namespace trocar::trainer {
namespace {

constexpr double kStill_s = 0.3;
constexpr std::size_t kFramesAPlot = 2;
constexpr double kGhost_mm = 1.0;  ///< The hand is drawn if it is at least this far ahead of the needle.
/// End of the force bar. Assumed: above the puncture forces of the embedded patients' layers (docs/validation.md), so
/// that peaks are visible.
constexpr double kFullForce_n = 8.0;

}  // namespace

AttemptControl::AttemptControl(std::shared_ptr<const cases::OpenCase> open, const TrainerChoice& choice,
                               attempt::AttemptOptions options, std::shared_ptr<attempt::HapticServers> servers,
                               WorkPage& page)
    : open_(std::move(open)),
      choice_(choice),
      page_(page),
      attempt_(open_, std::move(options), std::move(servers)),
      needle_(*open_->the_case.patient, open_->the_case.plan.line_P, open_->the_case.needle.length_mm),
      probe_(*open_->the_case.patient, attempt_.options().X_PT_start.value_or(open_->X_PT_start)),
      planned_(open_),
      hand_(open_, page.view_3d(), choice.mode != TrainingMode::kExam),
      is_led_{attempt::follows_targets(choice.needle_device), attempt::follows_targets(choice.probe_device)},
      keys_(page, [this](const QKeyEvent& key, const KeyPlace& place) { return take_key(key, place); }) {
  if (const auto& X_PN_start = attempt_.options().X_PN_start) needle_.put(*X_PN_start);
  page_.workspace().show_help(choice_.mode);  // the replay of the last attempt showed all
  page_.workspace().set_tip_hidden(is_tip_hidden());
  choose_layout(open_->the_case.task, page_.workspace());
  page_.xray().begin();
  connect_panel();
  ForcePlot& plot = page_.forces();
  plot.clear();
  plot.set_bands(is_exam() ? std::vector<ForcePlot::Band>{} : force_bands(*open_));
  plot.set_reference({});
  plot.set_cursor({});
  plot.set_predicted(is_exam() ? std::vector<QPointF>{} : predicted_curve(*open_));
  // A full-quality picture takes long without a graphics card: needle motion cancels it.
  page_.view_3d().set_interrupt([this] {
    constexpr double kMoved_mm = 0.5;
    const auto newest = attempt_.states().value();
    return newest && (newest->needle.X_PN.p() - view_.needle.X_PN.p()).norm() > kMoved_mm;
  });
  page_.puncture().begin(kFullForce_n, choice_.mode == TrainingMode::kGuided, open_->the_case.needle.is_biopsy,
                         actions_of(open_->the_case.task, open_->the_case.needle));
  take(attempt::first_tool(open_->the_case.task));
}

AttemptControl::~AttemptControl() {
  page_.view_3d().set_interrupt({});
  page_.xray().set_injection_hindrance({});
  page_.xray().pause_injection(false);
  page_.workspace().set_tip_hidden(false);
  gestures_.unwatch();
}

void AttemptControl::connect_panel() {
  PuncturePanel& panel = page_.puncture();
  connect(&panel, &PuncturePanel::tool_requested, this, &AttemptControl::take);
  connect(&panel, &PuncturePanel::clamp_requested, this, &AttemptControl::toggle_clamp);
  connect(&panel, &PuncturePanel::aim_requested, this, &AttemptControl::aim);
  connect(&panel, &PuncturePanel::fire_requested, this, &AttemptControl::fire);
  connect(&panel, &PuncturePanel::end_requested, this, &AttemptControl::ask_to_end);
  connect(&panel, &PuncturePanel::confirmed, this,
          [this] { question_ == Question::kEnd ? attempt_.finish() : Q_EMIT close_confirmed(); });
  connect(&panel, &PuncturePanel::action_requested, this, &AttemptControl::act);
  connect(&panel.steps(), &StepList::repeat_requested, this, [this](std::size_t step) { attempt_.repeat_phase(step); });
  connect(&gestures_, &ToolGestures::gestured, this, &AttemptControl::gesture);
  connect(&gestures_, &ToolGestures::taken, this, &AttemptControl::show_taken);
  connect(&page_.xray(), &XrayView::injection_refused, this, &AttemptControl::show_notice);
  gestures_.watch(page_.view_3d(), [this] { return scale_of_3d(); });
  gestures_.watch(page_.ultrasound(), [this] { return scale_of_ultrasound(); });
}

void AttemptControl::take(ActiveTool tool) {
  if (gestures_.active_tool() != tool) gestures_.take(tool);
  page_.puncture().show_active_tool(tool);
}

void AttemptControl::show_taken(ActiveTool tool) {
  page_.puncture().show_active_tool(tool);
  hand_.set_active(tool == ActiveTool::kFinger);
  if (tool == ActiveTool::kFinger && !hand_.failure().isEmpty()) show_notice(hand_.failure());
}

/// Actions that share a key are not offered together.
bool AttemptControl::is_offered(Action action) const {
  const tasks::Needle& needle = open_->the_case.needle;
  switch (action) {
    case Action::kFire:
      return needle.is_biopsy && !hand_.is_active();
    case Action::kMark:
    case Action::kRemoveMark:
      return hand_.is_active();
    case Action::kSelectFinger:  // the key of the cine loop, too
      return !(page_.ultrasound().hasFocus() && page_.ultrasound().is_frozen());
    case Action::kConfirm:
    case Action::kDecline:
    case Action::kFluoroscopy:
    case Action::kContrast:
      return false;  // by panel and view
    default:
      break;
  }
  const std::vector<Action> of_task = actions_of(open_->the_case.task, needle);
  const bool has_button =
      std::find(std::begin(kTraineeActions), std::end(kTraineeActions), action) != std::end(kTraineeActions);
  return !has_button || std::find(of_task.begin(), of_task.end(), action) != of_task.end();
}

bool AttemptControl::take_key(const QKeyEvent& key, const KeyPlace& place) {
  const auto found = find_action(Scope::kPuncture, key, [this](Action action) { return is_offered(action); });
  if (press_focused_button(key, place)) return true;
  if (!found) return false;
  if (found->action == Action::kForces) {
    // Space in a text field stops the forces but must not switch them on.
    if (place.is_text && attempt_.view().are_forces_stopped) return false;
    if (!key.isAutoRepeat()) toggle_forces();
    return true;
  }
  const KeyVerdict verdict = judge_key(row_of(found->action), key, place);
  if (verdict == KeyVerdict::kRefuse)
    show_notice(tr("A list or slider has the keyboard: click a view, then press the key again."));
  if (verdict == KeyVerdict::kPerform) return perform(*found, place);
  return verdict != KeyVerdict::kPass;
}

/// True if the action is done or refused with a reason.
bool AttemptControl::perform(const FoundAction& found, const KeyPlace& place) {
  switch (found.action) {
    case Action::kPlannedPosition:
      aim();
      return true;
    case Action::kLock:
      toggle_clamp();
      return true;
    case Action::kEnd:
      ask_to_end();
      return true;
    case Action::kFire:
      fire();
      return true;
    case Action::kMark:
      hand_.set_mark();
      return true;
    case Action::kRemoveMark:
      hand_.undo_mark();
      return true;
    case Action::kAnaesthetic:
    case Action::kStylet:
    case Action::kAspirate:
    case Action::kWire:
    case Action::kBreath:
    case Action::kLoad:
      act(found.action);
      return true;
    default:
      return gestures_.handle_action(found, place);
  }
}

void AttemptControl::ask_to_end() {
  question_ = Question::kEnd;
  page_.puncture().ask(tr("End the attempt and score it? It continues until you confirm."), tr("End (Enter)"));
}

void AttemptControl::ask_to_close() {
  question_ = Question::kClose;
  page_.puncture().ask(
      tr("Close the trainer? This ends the attempt: it is scored as it is if the needle was in the body."),
      tr("Close (Enter)"));
}

ViewScale AttemptControl::scale_of_3d() const {
  const PatientView& view = page_.view_3d();
  const scene::CameraView& camera = view.view();
  return {camera.right_P(), -camera.up_P, camera.mm_per_pixel(needle_.entry_P(), std::max(1, view.height()))};
}

ViewScale AttemptControl::scale_of_ultrasound() const {
  const UltrasoundView& view = page_.ultrasound();
  const auto picture = view.picture();
  if (!picture || view.measuring_tool() != MeasuringTool::kNone || view.is_frozen() || view.is_over_mark()) return {};
  const auto& corners_P = picture->corners_P;
  const Vec3 down_P = corners_P[2] - corners_P[0];
  return {(corners_P[1] - corners_P[0]).normalized(), down_P.normalized(), down_P.norm() / std::max(1, view.height())};
}

void AttemptControl::gesture(const Gesture& gesture) {
  planned_.stop(gestures_.active_tool());
  if (hand_.is_active() && gesture.kind == Gesture::Kind::kGlide) return hand_.glide(gesture.right, gesture.down);
  const ViewScale& v = gesture.view;
  const auto move = [&](auto& hand) {
    switch (gesture.kind) {
      case Gesture::Kind::kGlide:
        return hand.glide(gesture.right * v.right_P + gesture.down * v.down_P, v.right_P.cross(v.down_P));
      case Gesture::Kind::kTilt:
        return hand.tilt(v.right_P, v.down_P, gesture.right, gesture.down);
      case Gesture::Kind::kTurn:
        return hand.turn(gesture.right);
      case Gesture::Kind::kPush:
        return hand.push(gesture.right);
    }
  };
  if (gestures_.active_tool() == ActiveTool::kNeedle && is_free(attempt::Tool::kNeedle)) move(needle_);
  if (gestures_.active_tool() == ActiveTool::kTransducer && is_free(attempt::Tool::kProbe)) move(probe_);
}

bool AttemptControl::is_free(attempt::Tool tool) const {
  const auto t = static_cast<std::size_t>(tool);
  return is_led_[t] && !is_clamped_[t] && !view_.is_performing;
}

void AttemptControl::aim() {
  if (choice_.mode != TrainingMode::kGuided)
    return show_notice(tr("The planned position is available in guided attempts only."));
  const ActiveTool tool = gestures_.active_tool();
  if (tool == ActiveTool::kNone || tool == ActiveTool::kFinger)
    return show_notice(tr("Select needle (%1) or transducer (%2) first.")
                           .arg(keys_text(Action::kSelectNeedle), keys_text(Action::kSelectTransducer)));
  if (!is_free(tool == ActiveTool::kNeedle ? attempt::Tool::kNeedle : attempt::Tool::kProbe)) return;
  if (tool == ActiveTool::kNeedle && needle_.is_past_skin())
    return show_notice(tr("Withdraw the needle first: it moves to the planned position outside the body only."));
  planned_.start(tool);
}

void AttemptControl::show_notice(const QString& text) {
  constexpr double kNotice_s = 5.0;
  notice_ = text;
  notice_s_ = kNotice_s;
  is_notice_result_ = false;
}

void AttemptControl::fire() {
  if (!view_.is_gun_loaded)
    return show_notice(tr("The gun is empty: take the core out and load it (%1).").arg(keys_text(Action::kLoad)));
  attempt_.act({tasks::ActionKind::kFire});
}

void AttemptControl::act(Action action) {
  const ActionState state = action_state();
  if (const QString reason = why_not(action, state, open_->the_case.needle); !reason.isEmpty())
    return show_notice(reason);
  const tasks::ActionRequest request = attempt::request_of(trainee_action(action), state);
  if (action == Action::kWire) X_PN_wire_ = view_.needle.X_PN;
  attempt_.act(request);
}

ActionState AttemptControl::action_state() const {
  const bool can_act = view_.phase == attempt::AttemptPhase::kReady || view_.phase == attempt::AttemptPhase::kInBody;
  return {view_.is_stylet_drawn, view_.is_breath_held,        wire_mm(), can_act,
          view_.is_gun_loaded,   view_.needle.depth_mm <= 0.0};
}

void AttemptControl::toggle_clamp() {
  if (gestures_.active_tool() == ActiveTool::kNone || hand_.is_active()) return;
  const attempt::Tool tool =
      gestures_.active_tool() == ActiveTool::kNeedle ? attempt::Tool::kNeedle : attempt::Tool::kProbe;
  bool& is_clamped = is_clamped_[static_cast<std::size_t>(tool)];
  is_clamped = !is_clamped;
  attempt_.clamp(tool, is_clamped);
}

void AttemptControl::toggle_forces() {
  attempt_.view().are_forces_stopped ? attempt_.resume_forces() : attempt_.stop_forces();
}

void AttemptControl::end_server(const QString& tool) {
  const attempt::ServerView& server = view_.servers[tool == QLatin1String("probe") ? 1 : 0];
  if (server.pid > 0) ::kill(server.pid, SIGKILL);
}

void AttemptControl::advance(double dt_s) {
  view_ = attempt_.view();
  const bool are_on = view_.phase == attempt::AttemptPhase::kReady || view_.phase == attempt::AttemptPhase::kInBody;
  needle_.set_motion(view_.motion);
  probe_.set_motion(view_.motion);
  hand_.set_motion(view_.motion);
  if ((!are_on || !is_led_[0]) && view_.needle.is_known && view_.phase != attempt::AttemptPhase::kFinishing) {
    // The hands wait at the poses of the tools, to avoid a jump when the forces return.
    needle_.put(view_.needle.X_PN);
  }
  planned_.advance(needle_, probe_, view_, dt_s);
  hand_.advance();
  if (!is_led_[1] && view_.probe.is_known) probe_.put(view_.probe.X_PT);
  attempt_.set_goal(attempt::Tool::kNeedle, needle_.X_PN());
  attempt_.set_goal(attempt::Tool::kProbe, probe_.X_PT());
  ForcePlot& plot = page_.forces();
  if (++frame_ % kFramesAPlot == 0) {
    std::vector<ForcePoint> points;
    for (const trocar::attempt::ForcePoint& point : attempt_.take_forces())
      points.push_back({point.time_s, point.depth_mm, point.force_n});
    plot.append(points);
  }
  poll_events();
  poll_shot();
  notice_s_ -= dt_s;
  show_tools(dt_s);
  show_panel();
}

/// An exam shows no layer names and no labels: they would reveal the solution. What comes out of the needle is visible
/// to the trainee.
void AttemptControl::poll_events() {
  for (const attempt::AttemptEvent& event : attempt_.take_events()) {
    const bool is_action = event.name == "action", is_shot = event.name == "shot", is_pain = event.name == "pain";
    if (is_exam() && !is_shot && !is_action && !is_pain) continue;
    QString text = shown(event.text);
    if (is_exam() && is_shot) text = tr("the gun was fired");
    if (is_exam() && is_pain) text = tr("the patient feels pain");
    page_.puncture().add_event(QStringLiteral("%L1 s  %L2").arg(event.time_s, 0, 'f', 1).arg(text),
                               is_pain || event.harm > tasks::Harm::kNone);
    if (event.kind == telemetry::EventKind::kPuncture)
      page_.forces().add_event(event.depth_mm, event.time_s, shown(anatomy::layer_words(event.name)));
    if (!is_action && !is_pain) continue;
    show_notice(text.left(1).toUpper() + text.mid(1));
    constexpr double kResult_s = 8.0;
    is_notice_result_ = true;
    notice_s_ = kResult_s;
  }
}

void AttemptControl::poll_shot() {
  if (!view_.shot || view_.shots == shown_shots_) return;
  shown_shots_ = view_.shots;
  if (!is_exam()) page_.puncture().show_core(*view_.shot);  // in an exam its composition would reveal the solution
  page_.forces().add_event(view_.shot->depth_mm, view_.shot->time_s, tr("shot"));
  Q_EMIT gun_fired();
}

void AttemptControl::show_tools(double dt_s) {
  ToolsShown tools;
  tools.motion = view_.motion;
  const attempt::NeedleView& needle = view_.needle;
  if (needle.is_known) {
    tools.shaft_P = needle.shaft_P;
    tools.X_PN = needle.X_PN;
    tools.inside_mm = needle.depth_mm;
    // Outside the skin the slices show the position ahead of the needle.
    constexpr double kAhead_mm = 40.0;
    tools.focus_P =
        needle.depth_mm > 0.0 ? needle.X_PN.p() : Vec3(needle_.entry_P() + kAhead_mm * needle_.X_PN().R().col(2));
    const Pose& X_PN_goal = needle.X_PN_goal;
    const double length_mm = open_->the_case.needle.length_mm;
    if ((X_PN_goal.p() - needle.X_PN.p()).norm() > kGhost_mm)
      tools.goal_P = Segment{X_PN_goal.p() - length_mm * X_PN_goal.R().col(2), X_PN_goal.p()};
  }
  if (X_PN_wire_ && wire_mm() > 0.0)
    tools.wire_P = Segment{X_PN_wire_->p(), X_PN_wire_->p() + wire_mm() * X_PN_wire_->R().col(2)};
  page_.xray().set_injection_hindrance(injection_hindrance());
  page_.xray().pause_injection(!action_state().can_act);
  if (view_.has_probe && view_.probe.is_known) tools.X_PT = view_.probe.X_PT;
  constexpr double kMoving_mm_s = 0.5;
  const bool is_moving = std::abs(needle.speed_mm_s) > kMoving_mm_s || tools.goal_P.has_value();
  still_s_ = is_moving ? 0.0 : still_s_ + dt_s;
  tools.are_moving = still_s_ < kStill_s;
  if (!is_exam() && needle.is_known && view_.phase == attempt::AttemptPhase::kInBody && view_.is_gun_loaded)
    show_throw(tools, open_->the_case.needle);
  if (view_.shot && !view_.is_gun_loaded) show_shot(tools, *view_.shot, view_.since_shot_s, needle.depth_mm);
  hand_.add_to(tools);
  page_.workspace().show_tools(std::move(tools));
  if (tasks::XrayUse use = page_.xray().use(); use != xray_) attempt_.note_xray(xray_ = use);
}

double AttemptControl::distance_mm() const {
  return (view_.needle.X_PN.p() - view_.motion.to_now(open_->the_case.plan.line_P.b)).norm();
}

/// Why contrast agent cannot be injected now; empty: it can.
QString AttemptControl::injection_hindrance() const {
  const tasks::Needle& needle = open_->the_case.needle;
  if (needle.inner_diameter_mm <= 0.0) return tr("This needle has no lumen.");
  ActionState state = action_state();
  state.can_act = true;                              // an interruption pauses an injection
  return why_not(Action::kAspirate, state, needle);  // needs the same: a free lumen
}

QString AttemptControl::hint() const {
  return notice_s_ > 0.0 ? notice_ : shown(view_.hint);
}

void AttemptControl::show_panel() {
  PunctureFigures figures;
  figures.phase = phase_text(view_);
  figures.tissue = is_exam() ? QStringLiteral("–") : shown(view_.needle.tissue);
  const bool is_starting =
      view_.phase == attempt::AttemptPhase::kStarting || view_.phase == attempt::AttemptPhase::kFinishing;
  figures.hint = is_starting && notice_s_ <= 0.0 ? progress_text(view_) : hint();
  if (!is_tip_hidden()) figures.depth_mm = view_.needle.depth_mm;
  if (choice_.mode == TrainingMode::kGuided && view_.needle.is_known) figures.to_target_mm = distance_mm();
  figures.force_n = std::abs(view_.needle.resistance_n);
  figures.lag_mm = std::abs(view_.needle.lag_mm);
  figures.time_s = view_.session_s;
  figures.since_contact_s = view_.since_contact_s;
  figures.can_fire =
      open_->the_case.needle.is_biopsy && view_.is_gun_loaded && view_.phase == attempt::AttemptPhase::kInBody;
  figures.actions = action_state();
  figures.is_hint_notice = is_notice_result_ && notice_s_ > 0.0;
  figures.is_clamped[0] = is_clamped_[0];
  figures.is_clamped[1] = is_clamped_[1];
  show_steps();
  page_.puncture().show_figures(figures);
}

/// In an exam the loop sends no steps.
void AttemptControl::show_steps() {
  const std::vector<tasks::Phase>& phases = open_->the_case.task.phases;
  const bool is_guided = choice_.mode == TrainingMode::kGuided;
  const bool has_help = is_guided && view_.current_phase && *view_.current_phase < phases.size();
  page_.puncture().steps().show_steps(
      view_.phases, view_.current_phase, view_.needle.time_s, is_guided,
      has_help ? planned_position_help(open_->the_case.task, phases[*view_.current_phase]) : QString());
}

}  // namespace trocar::trainer
