#include "ultrasound/live/scan_schedule.h"

#include <algorithm>

namespace trocar::ultrasound {
namespace {

/// Nominal work of a frame, in samples: constant work (contact, scan conversion), and work for every sample, elevation
/// plane and steering angle. Measured with `trocar bench ultrasound-cost`; FrameCost learns the difference.
constexpr double kWorkOfFrame = 0.8e6, kWorkOfSample = 1.0, kWorkOfPlane = 1.0, kWorkOfAngle = 0.6;

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
  a.steering_angles = is_middle ? full.steering_angles : 1;
  a.scatterers = std::min(full.scatterers, is_middle ? 3.0 : 2.0);
  return a;
}

double ScanLevels::work(const ScanRequest& request, ScanDetail detail) const noexcept {
  const Acquisition a = with_detail(request.acquisition, detail);
  return kWorkOfFrame + a.lines * static_cast<double>(a.samples) *
                            (kWorkOfSample + kWorkOfPlane * a.planes + kWorkOfAngle * a.steering_angles);
}

}  // namespace trocar::ultrasound
