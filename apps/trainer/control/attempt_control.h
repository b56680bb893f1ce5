#pragma once

#include <QObject>
#include <QVariantMap>
#include <memory>

#include "attempt/live/live_attempt.h"
#include "attempt/tools/pointer_tools.h"
#include "cases/open_case.h"
#include "choice/trainer_choice.h"
#include "control/palpating_hand.h"
#include "control/planned_position.h"
#include "control/tool_gestures.h"
#include "panels/action_buttons.h"
#include "ui_kit/page_keys.h"

namespace trocar::trainer {

class WorkPage;

/// One attempt in the window: gestures move the tools, servers send states, workspace and panel display them.
class AttemptControl : public QObject {
  Q_OBJECT

 public:
  AttemptControl(std::shared_ptr<const cases::OpenCase> open, const TrainerChoice& choice,
                 attempt::AttemptOptions options, std::shared_ptr<attempt::HapticServers> servers, WorkPage& page);
  ~AttemptControl() override;

  /// Call once per frame.
  void advance(double dt_s);
  const attempt::AttemptView& view() const noexcept { return view_; }  ///< State of the last frame.
  attempt::LiveAttempt& attempt() noexcept { return attempt_; }
  /// Stops the forces, or restores them after a stop; works at any time, also while a server does not answer or starts.
  void toggle_forces();
  /// Requests confirmation to end and score the attempt, which continues in the meantime.
  void ask_to_end();
  /// Requests confirmation to close the program; the answer yes emits close_confirmed.
  void ask_to_close();
  void end_server(const QString& tool);
  /// Shows the text instead of the hint for some seconds.
  void show_notice(const QString& text);
  QVariantMap facts() const;

 Q_SIGNALS:
  void close_confirmed();
  void gun_fired();

 private:
  enum class Question { kEnd, kClose };
  void connect_panel();
  void gesture(const Gesture& gesture);
  bool take_key(const QKeyEvent& key, const KeyPlace& place);
  bool is_offered(Action action) const;
  bool perform(const FoundAction& found, const KeyPlace& place);
  void take(ActiveTool tool);
  void show_taken(ActiveTool tool);
  void aim();
  void toggle_clamp();
  void fire();
  void act(Action action);
  ActionState action_state() const;
  double wire_mm() const { return view_.wire_mm; }
  QString injection_hindrance() const;
  QString hint() const;
  void show_tools(double dt_s);
  void show_panel();
  void show_steps();
  void poll_events();
  void poll_shot();
  bool is_free(attempt::Tool tool) const;
  /// True in an exam that hides the needle tip in the body.
  bool is_tip_hidden() const noexcept { return is_exam() && !open_->the_case.task.exam_shows_needle; }
  bool is_exam() const noexcept { return choice_.mode == TrainingMode::kExam; }
  ViewScale scale_of_3d() const;
  ViewScale scale_of_ultrasound() const;
  QVariantMap solution_facts() const;
  void add_step_facts(QVariantMap& facts) const;
  double distance_mm() const;

  std::shared_ptr<const cases::OpenCase> open_;
  TrainerChoice choice_;
  WorkPage& page_;
  attempt::LiveAttempt attempt_;
  ToolGestures gestures_;
  attempt::PointerNeedle needle_;
  attempt::PointerProbe probe_;
  PlannedPosition planned_;
  PalpatingHand hand_;
  bool is_led_[2];  ///< By Tool: mouse and keys move the tool; else its device does.
  PageKeys keys_;
  bool is_clamped_[2] = {false, false};  ///< Indexed by Tool.
  attempt::AttemptView view_;
  tasks::XrayUse xray_;  ///< As noted last.
  std::size_t shown_shots_ = 0;
  double still_s_ = 0.0;
  Question question_ = Question::kEnd;  ///< The last question.
  QString notice_;
  double notice_s_ = 0.0;          ///< Remaining time of notice_.
  bool is_notice_result_ = false;  ///< notice_ is the result of an action.
  std::optional<Pose> X_PN_wire_;  ///< The needle as the wire was advanced last.
  std::size_t frame_ = 0;
};

}  // namespace trocar::trainer
