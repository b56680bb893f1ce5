#pragma once

#include <array>
#include <chrono>
#include <cstddef>

namespace trocar::scene {

/// Level of detail of a frame.
struct Detail {
  int mesh_level = 0;       ///< 0: all triangles; 1, 2: fewer, with simpler lighting.
  bool is_peeled = true;    ///< Depth peeling: translucent surfaces in depth order per pixel.
  bool is_smooth = true;    ///< Anti-aliased edges.
  bool has_volume = true;   ///< Volume rendering of the CT, if selected; otherwise surfaces replace it.
  double resolution = 1.0;  ///< Of the image relative to the window, 0.25..1.
  bool operator==(const Detail&) const = default;
};

inline constexpr int kMeshLevels = 3;

struct DetailPolicyParams {
  double target_ms = 32.0;                        ///< Frame time during motion. Range 5..500.
  double comfort = 0.55;                          ///< Below this share of the target, more detail is tried.
  int frames_before_finer = 20;                   ///< Consecutive frames below that share before. Range 1..1000.
  std::chrono::milliseconds still_after{300};     ///< Full quality after this time without motion.
  std::chrono::milliseconds retry_after{10'000};  ///< A level that was too slow is retried after it.
};

/// Selects the detail of the next frame from measured frame times. With a graphics card, every frame has full detail.
/// Without one, frames have full detail only after a time without motion; during motion, the level keeps the frame
/// time. Time is an argument.
class DetailPolicy {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit DetailPolicy(bool has_gpu, const DetailPolicyParams& params = {});

  /// Sets the target frame time, ms, 5..500.
  void set_target(double target_ms) noexcept { params_.target_ms = target_ms; }
  /// Reports a motion or change at this time: tool, camera, opacity.
  void note_motion(Time now) noexcept;
  /// Reports the duration of a frame of this detail. Cancelled frames are not reported.
  void note_frame(const Detail& detail, double frame_ms, Time now) noexcept;
  /// Detail of a frame that begins now.
  Detail next(Time now) const noexcept;
  bool is_moving(Time now) const noexcept;
  /// Level in use during motion: 0 is the finest.
  int moving_level() const noexcept { return level_; }

  static Detail full() noexcept { return {}; }
  static Detail moving(int level) noexcept;
  static constexpr int kMovingLevels = 5;

 private:
  DetailPolicyParams params_;
  bool has_gpu_;
  int level_ = 1;
  int comfortable_frames_ = 0;
  int slow_frames_ = 0;
  bool has_moved_ = false;
  Time last_motion_{};
  Time no_finer_before_{};
};

/// Recent frame times, ms.
class FrameTimes {
 public:
  void add(double frame_ms) noexcept;
  std::size_t count() const noexcept { return count_; }  ///< Number of all frames.
  double last_ms() const noexcept { return last_ms_; }
  /// Percentile of the last kKept frames; `share` in 0..1 (0.5: median). 0 without frames.
  double percentile_ms(double share) const noexcept;
  double p50_ms() const noexcept { return percentile_ms(0.5); }
  double p99_ms() const noexcept { return percentile_ms(0.99); }
  void clear() noexcept { *this = {}; }

  static constexpr std::size_t kKept = 256;

 private:
  std::array<double, kKept> kept_{};
  std::size_t count_ = 0;
  double last_ms_ = 0.0;
};

}  // namespace trocar::scene
