#pragma once

#include <array>
#include <optional>

#include "ultrasound/live/scan_request.h"

namespace trocar::ultrasound {

/// Level of detail of a frame, relative to the user's settings.
enum class ScanDetail { kFast, kMiddle, kFull };
inline constexpr std::size_t kScanDetails = 3;

/// Scanlines, samples, planes and looks of a detail; never finer than `full`, and no other knob changed.
Acquisition with_detail(const Acquisition& full, ScanDetail detail) noexcept;

/// What the schedule aims at.
struct ScanPace {
  double moving_ms = 55.0;  ///< A frame while something moves: 15 a second leave 66 ms. Range 10..500.
  double still_s = 0.3;     ///< So long nothing has moved: full detail. Range 0..5.
  double refresh_s = 0.1;   ///< Between frames of which only noise is new. Range 0.02..2.
  double doppler_s = 0.05;  ///< The same with colour, which follows the pulse.
  double busy_share = 0.5;  ///< Of the time that refreshing may take. Range 0.05..1.
  double tremor_mm = 0.05;  ///< A hand that moves less is still. Range 0..1.
};

/// Decides when a frame is due and at which detail, from measured frame times; time is an argument. During motion or
/// changes: the finest detail within the time budget; when still: full detail, then occasional refreshes.
class ScanSchedule {
 public:
  explicit ScanSchedule(const ScanPace& pace = {}) : pace_(pace) {}

  /// The detail of the frame that is due for a request, or nothing yet. now_s does not decrease.
  std::optional<ScanDetail> due(const ScanRequest& request, double now_s);
  /// A frame of that request is done: begun at begun_s, it took so long.
  void note_frame(const ScanRequest& request, ScanDetail detail, double begun_s, double took_ms);
  /// Another patient or transducer: the next request is due at once. What frames cost is kept.
  void restart() noexcept;

  /// What a frame of that detail is thought to take with `full`, ms; nothing before the first was measured.
  std::optional<double> expected_ms(const Acquisition& full, ScanDetail detail) const noexcept;

 private:
  ScanDetail detail_while_moving(const Acquisition& full) noexcept;

  ScanPace pace_;
  std::optional<ScanRequest> anchor_;  ///< Where stillness is measured from.
  double moved_s_ = 0.0;               ///< When the anchor was last left.
  std::optional<ScanRequest> shown_;
  ScanDetail shown_detail_ = ScanDetail::kFast;
  double shown_s_ = 0.0;
  double shown_ms_ = 0.0;
  ScanDetail moving_detail_ = ScanDetail::kFast;
  std::optional<double> load_;  ///< ms for each unit of work.
  /// Work of each detail beside its nominal one, learned.
  std::array<double, kScanDetails> correction_{1.0, 1.0, 1.0};
};

}  // namespace trocar::ultrasound
