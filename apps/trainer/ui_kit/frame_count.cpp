#include "ui_kit/frame_count.h"

#include <algorithm>

namespace trocar::trainer {

void FrameCount::add(double now_s, bool is_judged) {
  if (is_judged && !drawn_s_.empty()) {
    ++judged_;
    if (since_last_s(now_s) > kLate_s) ++late_;
  }
  drawn_s_.push_back(now_s);
  while (drawn_s_.size() > 2 && now_s - drawn_s_.front() > kOver_s) drawn_s_.pop_front();
}

std::optional<FrameFigures> FrameCount::figures() const {
  constexpr double kLeast_s = 0.5;
  if (drawn_s_.size() < 2 || drawn_s_.back() - drawn_s_.front() <= kLeast_s) return std::nullopt;
  FrameFigures figures{0.0, 0.0, late_, judged_};
  figures.per_s = static_cast<double>(drawn_s_.size() - 1) / (drawn_s_.back() - drawn_s_.front());
  for (std::size_t n = 1; n < drawn_s_.size(); ++n)
    figures.slowest_ms = std::max(figures.slowest_ms, 1e3 * (drawn_s_[n] - drawn_s_[n - 1]));
  return figures;
}

}  // namespace trocar::trainer
