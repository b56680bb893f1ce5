#include "attempt/record/recording_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace trocar::attempt {
namespace {

constexpr double kBytesATick = 11e6 / 60.0 / 1000.0;  // measured: 11 MB a minute at 1000 Hz
constexpr double kLeastStart_s = 10.0;
constexpr const char* kAdvice =
    "free some disk space, or start trocar-trainer with --state and a folder on another disk";

std::string duration_words(double seconds) {
  constexpr double kMinute_s = 60.0;
  if (seconds < 2.0 * kMinute_s) return fmt::format("{:.0f} s", seconds);
  return fmt::format("{:.0f} minutes", std::floor(seconds / kMinute_s));
}

}  // namespace

RecordingSpace::RecordingSpace(std::filesystem::path folder, std::optional<std::uintmax_t> free_bytes, double rate_hz)
    : folder_(std::move(folder)), bytes_a_second_(kBytesATick * rate_hz) {
  if (free_bytes) free_bytes_ = static_cast<double>(*free_bytes);
}

bool RecordingSpace::is_full() const noexcept {
  return free_bytes_ && *free_bytes_ < kClosing_bytes;
}

double RecordingSpace::left_s() const noexcept {
  return free_bytes_ ? std::max(0.0, *free_bytes_ - kClosing_bytes) / bytes_a_second_ : HUGE_VAL;
}

Status RecordingSpace::check_start() const {
  const double needed_bytes = kClosing_bytes + kLeastStart_s * bytes_a_second_;
  if (!free_bytes_ || *free_bytes_ >= needed_bytes) return {};
  return fail(fmt::format("the disk is full: {:.1f} MB are free in {}, an attempt needs at least {:.0f} MB",
                          *free_bytes_ / 1e6, folder_.string(), needed_bytes / 1e6),
              {}, kAdvice);
}

std::string RecordingSpace::start_warning() const {
  if (left_s() >= kAmple_s) return {};
  return fmt::format("The disk is almost full: {:.0f} MB are free in {}, enough to record {}.", *free_bytes_ / 1e6,
                     folder_.string(), duration_words(left_s()));
}

std::string RecordingSpace::banner() const {
  if (left_s() >= kScarce_s) return {};
  return fmt::format("The disk is almost full: {} can still be recorded in {}. Then the attempt ends and is scored",
                     duration_words(left_s()), folder_.string());
}

}  // namespace trocar::attempt
