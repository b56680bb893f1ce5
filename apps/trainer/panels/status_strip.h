#pragma once

#include <QFrame>
#include <vector>

#include "attempt/record/run_result.h"
#include "ui_kit/frame_count.h"

class QLabel;
class QPushButton;

namespace trocar::trainer {

/// What the strip tells of one haptic server.
struct ServerLine {
  QString tool;  ///< "Needle"
  bool is_connected = false;
  double rate_hz = 0.0;
  double served = 1.0;  ///< Share of periods that were served in time.
  double lateness_p99_us = 0.0;
  std::uint64_t ticks_missing = 0;
  QString fault;  ///< Empty: none.
  QString grant;  ///< What the system has granted, in words.
  bool is_real_time = false;

  bool operator==(const ServerLine&) const = default;
};

/// The strip at the foot of the window: figures of the haptic servers and of the window, and the force stop, always in
/// sight. A narrow window has fewer figures; tooltips have all of them.
class StatusStrip : public QFrame {
  Q_OBJECT

 public:
  explicit StatusStrip(QWidget* parent = nullptr);

  void show_servers(const std::vector<ServerLine>& servers);
  /// Of the window.
  void show_frames(const FrameFigures& frames);
  /// Whether an attempt goes on, and whether its forces are stopped; the button stops them or turns them on again.
  void show_forces(bool is_attempt, bool are_stopped);

 Q_SIGNALS:
  /// The button was pressed; Space acts alike.
  void toggle_requested();

 protected:
  void resizeEvent(QResizeEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  /// The most detail that has room beside the button.
  void fit_texts();
  void set_texts(int detail);

  QLabel* needle_ = nullptr;
  QLabel* probe_ = nullptr;
  QLabel* frames_ = nullptr;
  QPushButton* stop_ = nullptr;
  std::vector<ServerLine> shown_;
};

}  // namespace trocar::trainer
