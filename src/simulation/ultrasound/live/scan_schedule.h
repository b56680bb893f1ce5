#pragma once

#include "core/live/live_schedule.h"
#include "ultrasound/live/scan_request.h"

namespace trocar::ultrasound {

/// Level of detail of a frame, relative to the requested acquisition.
enum class ScanDetail { kFast, kMiddle, kFull };
inline constexpr std::size_t kScanDetails = 3;

/// Reduces scanlines, samples, elevation planes, steering angles and scatterers to a level; never finer than `full`.
/// Other settings stay the same, and so does the pattern of the speckle.
Acquisition with_detail(const Acquisition& full, ScanDetail detail) noexcept;

/// Times of a live ultrasound image.
struct ScanPace {
  LivePace live{.moving_ms = 40.0};  ///< 25 pictures a second, as a scanner.
  double refresh_s = 0.1;            ///< Time between frames in which only noise changes. Range 0.02..2.
  double doppler_s = 0.05;           ///< The same with colour Doppler, whose picture follows the pulse.
  double tremor_mm = 0.05;           ///< Smaller movements of transducer and needle count as rest. Range 0..1.
};

/// Requests and levels of detail of ultrasound for LiveSchedule.
class ScanLevels {
 public:
  using Request = ScanRequest;
  using Level = ScanDetail;
  static constexpr std::size_t kLevels = kScanDetails;

  ScanLevels() = default;
  explicit ScanLevels(const ScanPace& pace) : pace_(pace) {}

  LivePace pace() const noexcept { return pace_.live; }
  bool is_same(const ScanRequest& a, const ScanRequest& b) const noexcept {
    return is_equivalent(a, b, pace_.tremor_mm);
  }
  /// Work of a frame in samples.
  double work(const ScanRequest& request, ScanDetail detail) const noexcept;
  double refresh_s(const ScanRequest& request) const noexcept {
    return request.flow ? pace_.doppler_s : pace_.refresh_s;
  }

 private:
  ScanPace pace_;
};

/// While transducer, needle or settings change: the finest detail whose time stays within the pace. At rest: full
/// detail, then periodic refreshes.
using ScanSchedule = LiveSchedule<ScanLevels>;

}  // namespace trocar::ultrasound
