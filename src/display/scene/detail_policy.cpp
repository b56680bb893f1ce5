#include "scene/detail_policy.h"

#include <algorithm>
#include <cmath>

namespace trocar::scene {
namespace {

/// A single slow frame can be caused by another program; the second one counts.
constexpr int kSlowFrames = 2;
/// Factor above the target at which a single frame counts.
constexpr double kMuchTooSlow = 2.5;

}  // namespace

DetailPolicy::DetailPolicy(bool has_gpu, const DetailPolicyParams& params) : params_(params), has_gpu_(has_gpu) {}

Detail DetailPolicy::moving(int level) noexcept {
  switch (std::clamp(level, 0, kMovingLevels - 1)) {
    case 0:
      return {1, false, true, false, 1.0};
    case 1:
      return {1, false, false, false, 1.0};
    case 2:
      return {2, false, false, false, 1.0};
    case 3:
      return {2, false, false, false, 0.7};
    default:
      return {2, false, false, false, 0.5};
  }
}

void DetailPolicy::note_motion(Time now) noexcept {
  has_moved_ = true;
  last_motion_ = now;
}

bool DetailPolicy::is_moving(Time now) const noexcept {
  return has_moved_ && now - last_motion_ < params_.still_after;
}

Detail DetailPolicy::next(Time now) const noexcept {
  return has_gpu_ || !is_moving(now) ? full() : moving(level_);
}

void DetailPolicy::note_frame(const Detail& detail, double frame_ms, Time now) noexcept {
  if (has_gpu_ || detail != moving(level_)) return;
  if (frame_ms > params_.target_ms) {
    comfortable_frames_ = 0;
    ++slow_frames_;
    if (slow_frames_ < kSlowFrames && frame_ms < kMuchTooSlow * params_.target_ms) return;
    slow_frames_ = 0;
    if (level_ + 1 < kMovingLevels) ++level_;
    no_finer_before_ = now + params_.retry_after;
    return;
  }
  slow_frames_ = 0;
  comfortable_frames_ = frame_ms < params_.comfort * params_.target_ms ? comfortable_frames_ + 1 : 0;
  if (comfortable_frames_ < params_.frames_before_finer || now < no_finer_before_) return;
  comfortable_frames_ = 0;
  if (level_ > 0) --level_;
}

void FrameTimes::add(double frame_ms) noexcept {
  kept_[count_ % kKept] = frame_ms;
  ++count_;
  last_ms_ = frame_ms;
}

double FrameTimes::percentile_ms(double share) const noexcept {
  const std::size_t n = std::min(count_, kKept);
  if (n == 0) return 0.0;
  std::array<double, kKept> sorted = kept_;
  const auto rank = static_cast<std::size_t>(std::ceil(std::clamp(share, 0.0, 1.0) * static_cast<double>(n)));
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(rank == 0 ? 0 : rank - 1);
  std::nth_element(sorted.begin(), at, sorted.begin() + static_cast<std::ptrdiff_t>(n));
  return *at;
}

}  // namespace trocar::scene
