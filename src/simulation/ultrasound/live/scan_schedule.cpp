#include "ultrasound/live/scan_schedule.h"

#include <algorithm>
#include <cmath>

namespace trocar::ultrasound {
namespace {

/// Nominal work of a frame, in samples: a constant part (contact, scan conversion), per sample, and per plane and
/// compounding angle. From frames of the embedded abdomen; deviations are learned.
constexpr double kWorkOfFrame = 1.3e6, kWorkOfSample = 1.0, kWorkOfPlane = 1.0, kWorkOfLook = 0.6;

/// Fractions of a new measurement assigned to the machine's load and to the detail's own work. The first is larger:
/// servers and windows start and end, the cost of a detail is constant.
constexpr double kLoadShare = 0.5, kCorrectionShare = 0.1;
/// Learned values of unused details decay with each frame, so that they are tried again.
constexpr double kMemory = 0.985;
/// Limit for a single interrupted frame.
constexpr double kMostSurprise = 3.0;
/// A finer detail starts only if it leaves this margin in the time budget, to avoid alternation.
constexpr double kRoomToRefine = 0.8;

std::size_t at(ScanDetail detail) noexcept {
  return static_cast<std::size_t>(detail);
}

double work(const Acquisition& full, ScanDetail detail) noexcept {
  const Acquisition a = with_detail(full, detail);
  return kWorkOfFrame +
         a.lines * static_cast<double>(a.samples) * (kWorkOfSample + kWorkOfPlane * a.planes + kWorkOfLook * a.looks);
}

}  // namespace

Acquisition with_detail(const Acquisition& full, ScanDetail detail) noexcept {
  if (detail == ScanDetail::kFull) return full;
  const bool is_middle = detail == ScanDetail::kMiddle;
  Acquisition a = full;
  a.lines = std::max(16, is_middle ? full.lines * 3 / 4 : full.lines / 2);
  a.samples = std::max(64, is_middle ? full.samples * 3 / 4 : full.samples / 2);
  a.lines = std::min(a.lines, full.lines);
  a.samples = std::min(a.samples, full.samples);
  // A single plane makes borders too bright and sharp, and saves little time.
  a.planes = std::min(full.planes, 3);
  a.looks = std::min(full.looks, is_middle ? 2 : 1);
  return a;
}

std::optional<double> ScanSchedule::expected_ms(const Acquisition& full, ScanDetail detail) const noexcept {
  if (!load_) return std::nullopt;
  return *load_ * correction_[at(detail)] * work(full, detail);
}

ScanDetail ScanSchedule::detail_while_moving(const Acquisition& full) noexcept {
  if (!load_) return ScanDetail::kFast;
  ScanDetail best = ScanDetail::kFast;
  for (const ScanDetail detail : {ScanDetail::kMiddle, ScanDetail::kFull}) {
    const double room = at(detail) > at(moving_detail_) ? kRoomToRefine : 1.0;
    if (*expected_ms(full, detail) <= room * pace_.moving_ms) best = detail;
  }
  return moving_detail_ = best;
}

std::optional<ScanDetail> ScanSchedule::due(const ScanRequest& request, double now_s) {
  if (!anchor_ || !is_as_good(*anchor_, request, pace_.tremor_mm)) {
    anchor_ = request;
    moved_s_ = now_s;
  }
  const bool is_still = now_s - moved_s_ >= pace_.still_s;
  if (!shown_ || !is_as_good(*shown_, request, pace_.tremor_mm))
    return is_still ? ScanDetail::kFull : detail_while_moving(request.acquisition);
  if (is_still && shown_detail_ != ScanDetail::kFull) return ScanDetail::kFull;
  const double refresh_s = std::max(request.has_doppler ? pace_.doppler_s : pace_.refresh_s,
                                    1e-3 * shown_ms_ / std::clamp(pace_.busy_share, 0.05, 1.0));
  if (now_s - shown_s_ < refresh_s) return std::nullopt;
  return is_still ? ScanDetail::kFull : detail_while_moving(request.acquisition);
}

void ScanSchedule::note_frame(const ScanRequest& request, ScanDetail detail, double begun_s, double took_ms) {
  shown_ = request;
  shown_detail_ = detail;
  shown_s_ = begun_s;
  shown_ms_ = took_ms;
  if (!(took_ms > 0.0)) return;
  const std::optional<double> expected = expected_ms(request.acquisition, detail);
  if (!expected) {
    load_ = took_ms / work(request.acquisition, detail);
    return;
  }
  const double surprise = std::clamp(took_ms / *expected, 1.0 / kMostSurprise, kMostSurprise);
  *load_ *= std::pow(surprise, kLoadShare);
  for (double& correction : correction_) correction = std::pow(correction, kMemory);
  correction_[at(detail)] *= std::pow(surprise, kCorrectionShare);
}

void ScanSchedule::restart() noexcept {
  anchor_.reset();
  shown_.reset();
}

}  // namespace trocar::ultrasound
