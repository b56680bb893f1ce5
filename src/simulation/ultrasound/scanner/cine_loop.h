#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/pose.h"
#include "ultrasound/probe/scan_geometry.h"
#include "ultrasound/scanner/display_settings.h"

namespace trocar::ultrasound {

/// One stored frame: input of Scanner::show_levels, with its pose and time.
struct CineFrame {
  Pose X_PT;
  double time_s = 0.0;
  DisplaySettings settings;  ///< Settings of the recording; TGC is already included in the levels.
  std::span<const std::uint8_t> levels;
};

/// The last pictures of a scan, in memory that is allocated once. While the loop is frozen, no frame is added, and one
/// frame of a range is selected for display. One geometry: a change of depth or transducer begins a new loop. Frames
/// count from the oldest, 0.
class CineLoop {
 public:
  /// capacity >= 1. Each frame has the lines and samples of `scan`, one byte per sample.
  CineLoop(const ScanGeometry& scan, int capacity);

  const ScanGeometry& scan() const noexcept { return scan_; }
  int capacity() const noexcept { return static_cast<int>(moments_.size()); }
  int size() const noexcept { return size_; }
  bool is_frozen() const noexcept { return is_frozen_; }

  /// Adds the newest frame (Scanner::levels()), in place of the oldest when full; does nothing while frozen. time_s
  /// does not decrease. Real-time safe.
  void push(std::span<const std::uint8_t> levels, const Pose& X_PT, double time_s, const DisplaySettings& settings);
  /// Clears all frames and unfreezes the loop. Real-time safe.
  void restart() noexcept;

  /// Freezes the loop at the newest frame, with the range over all frames. Has no effect without frames.
  void freeze() noexcept;
  /// Unfreezes the loop; stored frames remain until they are replaced.
  void thaw() noexcept { is_frozen_ = false; }

  /// Sets the range of frames for stepping and playing in the frozen loop, clamped to the stored frames; first <= last.
  void set_range(int first, int last) noexcept;
  int first() const noexcept { return first_; }
  int last() const noexcept { return last_; }
  /// Displayed frame; the newest one while not frozen, -1 without frames.
  int position() const noexcept { return is_frozen_ ? position_ : size_ - 1; }
  /// Moves by that many frames (negative: back), at most to the end of the range. Frozen only.
  void step(int frames) noexcept;
  /// Advances by a time of the recording; after the range's last frame comes its first one. Frozen only; elapsed_s >=
  /// 0.
  void play(double elapsed_s) noexcept;

  /// Frame 0..size()-1. Valid until the next push or restart.
  CineFrame frame(int index) const;

 private:
  struct Moment {
    Pose X_PT;
    double time_s = 0.0;
    DisplaySettings settings;
  };
  std::size_t slot(int index) const noexcept;
  double time_s(int index) const noexcept { return moments_[slot(index)].time_s; }

  ScanGeometry scan_;
  std::size_t frame_bytes_;
  std::vector<Moment> moments_;
  std::vector<std::uint8_t> levels_;
  int oldest_ = 0;  ///< Slot of frame 0.
  int size_ = 0;
  bool is_frozen_ = false;
  int first_ = 0, last_ = 0, position_ = 0;
  double played_s_ = 0.0;  ///< Time played since the time of the displayed frame.
};

}  // namespace trocar::ultrasound
