#include "core/live/live_schedule.h"

#include <algorithm>
#include <cmath>

namespace trocar {
inline namespace core {
namespace {

/// Parts of a new measurement that change the time per work and the level's own correction. The first is larger: other
/// processes start and end, the relative cost of a level stays.
constexpr double kLoadShare = 0.5, kCorrectionShare = 0.1;
/// Corrections fade with each frame, so that levels not in use are tried again.
constexpr double kMemory = 0.985;
/// Limit of the ratio of measured to expected time: a frame that was interrupted for long is no measurement.
constexpr double kGreatestRatio = 3.0;
/// Share of the target that a finer level may take, so that levels do not alternate.
constexpr double kShareToRefine = 0.8;

}  // namespace

std::optional<double> FrameCost::expected_ms(std::size_t level, double work) const noexcept {
  if (!ms_per_work_) return std::nullopt;
  return *ms_per_work_ * corrections_[level] * work;
}

void FrameCost::note(std::size_t level, double work, double took_ms) noexcept {
  if (!(took_ms > 0.0)) return;
  const std::optional<double> expected = expected_ms(level, work);
  if (!expected) {
    ms_per_work_ = took_ms / work;
    return;
  }
  const double ratio = std::clamp(took_ms / *expected, 1.0 / kGreatestRatio, kGreatestRatio);
  *ms_per_work_ *= std::pow(ratio, kLoadShare);
  for (double& correction : corrections_) correction = std::pow(correction, kMemory);
  corrections_[level] *= std::pow(ratio, kCorrectionShare);
}

std::size_t FrameCost::select_level(std::span<const double> work, double target_ms) noexcept {
  if (!ms_per_work_) return 0;
  std::size_t best = 0;
  for (std::size_t level = 1; level < corrections_.size(); ++level) {
    const double room = level > selected_ ? kShareToRefine : 1.0;
    if (*expected_ms(level, work[level]) <= room * target_ms) best = level;
  }
  return selected_ = best;
}

}  // namespace core
}  // namespace trocar

#ifdef __linux__
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

namespace trocar {
inline namespace core {

void lower_priority(int nice) noexcept {
#ifdef __linux__
  const auto thread = static_cast<id_t>(::syscall(SYS_gettid));
  (void)::setpriority(PRIO_PROCESS, thread, ::getpriority(PRIO_PROCESS, thread) + nice);
#else
  (void)nice;
#endif
}

}  // namespace core
}  // namespace trocar
