#pragma once

#include <QWidget>
#include <optional>
#include <vector>

#include "panels/action_buttons.h"

class QButtonGroup;
class QFrame;
class QLabel;
class QListWidget;
class QPushButton;
class QScrollArea;
class QShortcut;

namespace trocar::attempt {
struct GunShot;
}

namespace trocar::trainer {

class CorePicture;
class ForceBar;
class StepList;

using attempt::ActiveTool;

/// Contents of the panel in one frame.
struct PunctureFigures {
  QString phase;
  QString tissue;
  QString hint;
  bool is_hint_notice = false;         ///< The hint is the result of an action: shown prominently.
  std::optional<double> depth_mm;      ///< Empty: hidden.
  std::optional<double> to_target_mm;  ///< Empty without help.
  double force_n = 0.0;
  double lag_mm = 0.0;           ///< Lag of the tool behind the hand.
  double time_s = 0.0;           ///< Time of the session.
  double since_contact_s = 0.0;  ///< Since contact with the skin.
  bool can_fire = false;
  bool is_clamped[2] = {false, false};  ///< Needle, transducer.
  ActionState actions;
};

/// Panel during the puncture: steps of the procedure, actions, active tool, needle position, resistance, events. Keys:
/// A, S and P select a tool, V none, X locks the active tool, Enter fires, E ends; those of the actions: key_of(). A
/// question replaces the last two buttons and does not pause the attempt; Enter and Escape answer it.
class PuncturePanel : public QWidget {
  Q_OBJECT

 public:
  explicit PuncturePanel(QWidget* parent = nullptr);

  /// `can_aim`: the tools may be moved to their planned poses. `has_gun`: the needle is that of a biopsy gun.
  void begin(double most_force_n, bool can_aim, bool has_gun = true, const std::vector<Action>& actions = {});
  void show_figures(const PunctureFigures& figures);
  StepList& steps() noexcept { return *steps_; }
  /// In pixels: what its buttons and texts need beside the scroll bar.
  int needed_width() const;
  void show_active_tool(ActiveTool tool);
  /// A bad event has the colour of errors.
  void add_event(const QString& text, bool is_bad = false);
  /// Shows the core of the biopsy gun until the next begin().
  void show_core(const attempt::GunShot& shot);
  /// Shows a question. There is one question at a time: a second one replaces the first.
  void ask(const QString& question, const QString& yes);
  bool is_asking() const;

 Q_SIGNALS:
  void tool_requested(trocar::trainer::ActiveTool tool);
  void clamp_requested();
  void aim_requested();
  void fire_requested();
  void end_requested();
  void action_requested(trocar::trainer::Action action);
  void asked();
  /// The question was answered with yes.
  void confirmed();

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  QWidget* make_question();
  void answer(bool is_yes);
  QWidget* make_tool_choice();
  QWidget* make_figures();
  void make_content(QWidget& inside);
  void show_hint(const PunctureFigures& figures);

  QButtonGroup* tool_buttons_ = nullptr;
  QPushButton* clamp_ = nullptr;
  QPushButton* aim_ = nullptr;
  QLabel* phase_ = nullptr;
  QLabel* tissue_ = nullptr;
  QLabel* depth_ = nullptr;
  QLabel* target_ = nullptr;
  QLabel* time_ = nullptr;
  QLabel* hint_ = nullptr;
  StepList* steps_ = nullptr;
  ActionButtons* actions_ = nullptr;
  ForceBar* force_ = nullptr;
  CorePicture* core_ = nullptr;
  QListWidget* events_ = nullptr;
  QScrollArea* scroll_ = nullptr;
  QPushButton* fire_ = nullptr;
  bool has_gun_ = true;
  QPushButton* end_ = nullptr;
  QFrame* question_ = nullptr;
  QLabel* question_text_ = nullptr;
  QPushButton* yes_ = nullptr;
  std::vector<QShortcut*> answers_;  ///< Keys that are active while a question is open.
};

}  // namespace trocar::trainer
