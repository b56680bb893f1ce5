#pragma once

#include <QElapsedTimer>
#include <QFrame>
#include <vector>

#include "attempt/record/score_session.h"
#include "panels/status_health.h"
#include "ui_kit/page_keys.h"

class QLabel;
class QPushButton;
class QToolButton;

namespace trocar::trainer {

/// Status bar of the window: one indicator of the state of forces and pictures, and the force stop button, which is
/// always visible. A click on the indicator shows or hides the figures behind it, above the bar; its tooltip has them,
/// too. Escape closes them. The figures do not take the keyboard: Space stops the forces while they are open.
class StatusStrip : public QFrame {
  Q_OBJECT

 public:
  explicit StatusStrip(QWidget* parent = nullptr);

  /// Empty: no attempt.
  void show_servers(const std::vector<ServerLine>& servers);
  /// Figures of the window.
  void show_frames(const FrameFigures& frames);
  /// Sets whether an attempt is running and whether its forces are stopped; the button stops or restores them.
  void show_forces(bool is_attempt, bool are_stopped);

  const HealthReport& report() const noexcept { return report_; }
  /// True while the figures are open.
  bool shows_details() const;
  void set_details_shown(bool are_shown);

 Q_SIGNALS:
  /// The button or Space was pressed.
  void toggle_requested();

 protected:
  void resizeEvent(QResizeEvent* event) override;
  void moveEvent(QMoveEvent* event) override;
  void changeEvent(QEvent* event) override;
  bool event(QEvent* event) override;

 private:
  void update_health();
  void update_symbol();
  void place_details();

  QToolButton* indicator_ = nullptr;
  QLabel* reason_ = nullptr;  ///< One sentence beside the indicator; hidden in a narrow window.
  QPushButton* stop_ = nullptr;
  QFrame* details_ = nullptr;  ///< A child of the window, above the strip.
  QLabel* figures_ = nullptr;
  HealthInput input_;
  HealthReport report_;
  QElapsedTimer refreshed_;  ///< When the figures were set last.
  PageKeys keys_;            ///< Escape closes the figures.
};

}  // namespace trocar::trainer
