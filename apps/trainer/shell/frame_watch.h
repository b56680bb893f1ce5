#pragma once

#include <QVariantMap>
#include <cstdint>
#include <vector>

#include "ui_kit/frame_count.h"

namespace trocar::trainer {

class StatusStrip;
class WorkPage;

/// Times of the frames of attempts and replays, and of the ultrasound images in them, since the last reset: for the
/// status strip, scripts and benchmarks.
class FrameWatch {
 public:
  /// Since the former frame, s; 0 before the first.
  double since_last_s(double now_s) const { return frames_.since_last_s(now_s); }
  /// Call at the end of each frame. `is_shown`: of an attempt or a replay; `is_attempt`: late frames count.
  void note_frame(double now_s, bool is_shown, bool is_attempt, WorkPage& page, StatusStrip& strip);
  /// Counts late frames anew.
  void restart() { frames_.restart(); }
  void reset(double now_s);
  void add_facts(QVariantMap& facts, double now_s) const;

 private:
  FrameCount frames_;
  std::vector<double> frame_ms_, scan_ms_;
  std::uint64_t last_scan_ = 0;  ///< Number of the last ultrasound image.
  double since_s_ = 0.0;
};

}  // namespace trocar::trainer
