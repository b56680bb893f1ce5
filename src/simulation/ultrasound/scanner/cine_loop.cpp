#include "ultrasound/scanner/cine_loop.h"

#include <algorithm>
#include <cmath>

#include "core/result.h"

namespace trocar::ultrasound {

CineLoop::CineLoop(const ScanGeometry& scan, int capacity)
    : scan_(scan), frame_bytes_(static_cast<std::size_t>(scan.lines) * static_cast<std::size_t>(scan.samples)) {
  TROCAR_CHECK(capacity >= 1);
  moments_.resize(static_cast<std::size_t>(capacity));
  levels_.resize(moments_.size() * frame_bytes_);
}

std::size_t CineLoop::slot(int index) const noexcept {
  return static_cast<std::size_t>((oldest_ + index) % capacity());
}

void CineLoop::push(std::span<const std::uint8_t> levels, const Pose& X_PT, double time_s,
                    const DisplaySettings& settings) {
  TROCAR_CHECK(levels.size() == frame_bytes_);
  if (is_frozen_) return;
  if (size_ == capacity()) {
    oldest_ = (oldest_ + 1) % capacity();
  } else {
    ++size_;
  }
  const std::size_t place = slot(size_ - 1);
  moments_[place] = {X_PT, time_s, settings};
  std::copy(levels.begin(), levels.end(), levels_.begin() + static_cast<std::ptrdiff_t>(place * frame_bytes_));
}

void CineLoop::restart() noexcept {
  oldest_ = size_ = 0;
  is_frozen_ = false;
}

void CineLoop::freeze() noexcept {
  if (is_frozen_ || size_ == 0) return;
  is_frozen_ = true;
  first_ = 0;
  last_ = position_ = size_ - 1;
  played_s_ = 0.0;
}

void CineLoop::set_range(int first, int last) noexcept {
  if (!is_frozen_) return;
  first_ = std::clamp(first, 0, size_ - 1);
  last_ = std::clamp(last, first_, size_ - 1);
  step(0);
}

void CineLoop::step(int frames) noexcept {
  if (!is_frozen_) return;
  // No sum can overflow: a step is never longer than the loop.
  position_ = std::clamp(position_ + std::clamp(frames, -size_, size_), first_, last_);
  played_s_ = 0.0;
}

void CineLoop::play(double elapsed_s) noexcept {
  if (!is_frozen_ || first_ == last_ || !(elapsed_s >= 0.0) || !std::isfinite(elapsed_s)) return;
  // The display time of the last frame before the loop restarts is the mean frame interval.
  const double span_s = time_s(last_) - time_s(first_);
  const double pause_s = span_s / (last_ - first_);
  if (!(span_s > 0.0)) return;
  const double since_first_s = time_s(position_) - time_s(first_) + played_s_ + elapsed_s;
  const double now_s = time_s(first_) + std::fmod(since_first_s, span_s + pause_s);
  position_ = first_;
  while (position_ < last_ && time_s(position_ + 1) <= now_s) ++position_;
  played_s_ = now_s - time_s(position_);
}

CineFrame CineLoop::frame(int index) const {
  TROCAR_CHECK(index >= 0 && index < size_);
  const std::size_t place = slot(index);
  const Moment& moment = moments_[place];
  return {moment.X_PT, moment.time_s, moment.settings, std::span(levels_).subspan(place * frame_bytes_, frame_bytes_)};
}

}  // namespace trocar::ultrasound
