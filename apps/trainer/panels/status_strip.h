#pragma once

#include <QFrame>
#include <vector>

#include "attempt/record/run_result.h"
#include "ui_kit/frame_count.h"

class QLabel;
class QPushButton;

namespace trocar::trainer {

/// Figures of one haptic server in the strip.
struct ServerLine {
  QString tool;  ///< "Needle"
  bool is_connected = false;
  double rate_hz = 0.0;
  double served = 1.0;  ///< Share of periods that were served in time.
  double lateness_p99_us = 0.0;
  std::uint64_t ticks_missing = 0;
  QString fault;  ///< Empty: none.
  QString grant;  ///< Granted real-time privileges, as text.
  bool is_real_time = false;

  bool operator==(const ServerLine&) const = default;
};

/// Status bar of the window: figures of the haptic servers and of the window, and the force stop button, which is
/// always visible. A narrow window has fewer figures; tooltips have all of them.
class StatusStrip : public QFrame {
  Q_OBJECT

 public:
  explicit StatusStrip(QWidget* parent = nullptr);

  void show_servers(const std::vector<ServerLine>& servers);
  /// Figures of the window.
  void show_frames(const FrameFigures& frames);
  /// Sets whether an attempt is running and whether its forces are stopped; the button stops or restores them.
  void show_forces(bool is_attempt, bool are_stopped);

 Q_SIGNALS:
  /// The button or Space was pressed.
  void toggle_requested();

 protected:
  void resizeEvent(QResizeEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  /// Selects the most detailed texts that fit beside the button.
  void fit_texts();
  void set_texts(int detail);

  QLabel* needle_ = nullptr;
  QLabel* probe_ = nullptr;
  QLabel* frames_ = nullptr;
  QPushButton* stop_ = nullptr;
  std::vector<ServerLine> shown_;
};

}  // namespace trocar::trainer
