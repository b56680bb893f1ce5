#pragma once

#include <QFrame>
#include <vector>

#include "headless/run_result.h"

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

/// The strip at the foot of the window: what the servers and the window really do, and the force stop, always in sight.
class StatusStrip : public QFrame {
  Q_OBJECT

 public:
  explicit StatusStrip(QWidget* parent = nullptr);

  void show_servers(const std::vector<ServerLine>& servers);
  /// Of the window: frames drawn a second, and frames that came too late for the eye.
  void show_frames(double frames_per_s, std::uint64_t dropped);
  /// Whether forces are on; the button turns them off or on again.
  void show_forces(bool are_possible, bool are_on);

 Q_SIGNALS:
  void stop_wanted();
  void resume_wanted();

 private:
  QLabel* needle_ = nullptr;
  QLabel* probe_ = nullptr;
  QLabel* frames_ = nullptr;
  QPushButton* stop_ = nullptr;
  std::vector<ServerLine> shown_;
  bool are_on_ = false;
};

}  // namespace trocar::trainer
