#include "shell/frame_watch.h"

#include <algorithm>
#include <utility>

#include "pages/work_page.h"
#include "panels/status_strip.h"
#include "views/patient/patient_view.h"
#include "views/ultrasound/ultrasound_view.h"

namespace trocar::trainer {
namespace {

constexpr std::size_t kMostFrames = 200'000;  // an hour

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace

void FrameWatch::note_frame(double now_s, bool is_shown, bool is_attempt, WorkPage& page, StatusStrip& strip) {
  const double frame_s = frames_.since_last_s(now_s);
  if (frame_s > 0.0 && is_shown && frame_ms_.size() < kMostFrames) frame_ms_.push_back(1e3 * frame_s);
  const auto picture = page.ultrasound().picture();
  if (picture && std::exchange(last_scan_, picture->number) != picture->number && scan_ms_.size() < kMostFrames)
    scan_ms_.push_back(picture->took_ms);
  frames_.add(now_s, is_attempt);
  if (const auto figures = frames_.figures()) strip.show_frames(*figures);
}

void FrameWatch::reset(double now_s) {
  frame_ms_.clear();
  scan_ms_.clear();
  since_s_ = now_s;
}

void FrameWatch::add_facts(QVariantMap& facts, double now_s) const {
  facts[QStringLiteral("late_frames")] = static_cast<qulonglong>(frames_.late());
  facts[QStringLiteral("frame_p50_ms")] = quantile(frame_ms_, 0.5);
  facts[QStringLiteral("frame_p99_ms")] = quantile(frame_ms_, 0.99);
  const double watched_s = now_s - since_s_;
  facts[QStringLiteral("ultrasound_per_s")] = static_cast<double>(scan_ms_.size()) / std::max(watched_s, 1e-3);
  facts[QStringLiteral("ultrasound_p50_ms")] = quantile(scan_ms_, 0.5);
  facts[QStringLiteral("ultrasound_p99_ms")] = quantile(scan_ms_, 0.99);
}

}  // namespace trocar::trainer
