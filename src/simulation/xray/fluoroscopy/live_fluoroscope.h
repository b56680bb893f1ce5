#pragma once

#include <memory>
#include <optional>

#include "core/live/feed.h"
#include "core/live/live_schedule.h"
#include "xray/fluoroscopy/fluoroscope.h"

namespace trocar::xray {

/// Times of live fluoroscopy.
struct FluoroscopyPace {
  LivePace live{.moving_ms = 55.0, .still_s = 0.2, .busy_share = 0.9};
};

/// Fluoroscopy for LiveSchedule. It has one level of detail: a coarser projection of the patient saved no time
/// (docs/validation.md).
class FluoroscopySchedule {
 public:
  using Request = FluoroscopyRequest;
  enum class Level { kFull };
  static constexpr std::size_t kLevels = 1;

  FluoroscopySchedule() = default;
  explicit FluoroscopySchedule(const FluoroscopyPace& pace) : pace_(pace) {}

  LivePace pace() const noexcept { return pace_.live; }
  /// Tools, contrast agent and noise are drawn at each pulse: only C-arm, motion, exposure and display decide.
  bool is_same(const FluoroscopyRequest& a, const FluoroscopyRequest& b) const noexcept;
  /// Work of a frame: its pixels.
  double work(const FluoroscopyRequest& request, Level) const noexcept;
  /// One frame a pulse.
  double refresh_s(const FluoroscopyRequest& request) const noexcept { return 1.0 / request.pulses_per_s; }

 private:
  FluoroscopyPace pace_;
};

/// Limits of a live fluoroscope's processor time, which leave time for real-time threads.
struct LiveFluoroscopeOptions {
  int threads = 1;  ///< Threads per frame. Range 1..64.
  int nice = 5;     ///< Added to the worker's niceness where the system has one. Range 0..19.
  FluoroscopyPace pace;
  DetectorParams detector;
  ExposureLimits limits;
};
/// One thread on small machines; more on machines where two servers, the window and the drawing still have a core each.
LiveFluoroscopeOptions default_live_fluoroscope_options();

/// A live fluoroscope: a thread renders the newest request (older ones are dropped). With the pedal up it holds the
/// last image and renders only if its display changes. One thread, e.g. that of the window, makes all calls; only the
/// destructor waits for a frame.
class LiveFluoroscope {
 public:
  explicit LiveFluoroscope(const LiveFluoroscopeOptions& options = default_live_fluoroscope_options());
  ~LiveFluoroscope();
  LiveFluoroscope(const LiveFluoroscope&) = delete;
  LiveFluoroscope& operator=(const LiveFluoroscope&) = delete;

  /// Sets another patient: removes images, requests and dose.
  void open(std::shared_ptr<const XrayVolume> volume);
  /// A request with a non-finite time or motion is ignored.
  void request(FluoroscopyRequest request);
  /// The images, for any thread; none before the first pulse.
  const Feed<FluoroscopyFrame>& frames() const noexcept;
  /// The error of the last request, if it failed: an impossible C-arm or tube.
  std::optional<Error> error() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::xray
