#include "xray/fluoroscopy/live_fluoroscope.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>
#include <utility>

#include "core/live/live_worker.h"
#include "core/random.h"
#include "xray/fluoroscopy/detail/patient_image.h"

namespace trocar::xray {

/// How LiveWorker makes X-ray images.
struct FluoroscopyTraits : FluoroscopySchedule {
  using FluoroscopySchedule::FluoroscopySchedule;
  using Image = FluoroscopyFrame;
  static void stamp(FluoroscopyFrame& frame, std::uint64_t number, double took_ms) noexcept {
    frame.number = number;
    frame.took_ms = took_ms;
  }
};

namespace {

/// Cores for two servers' loops, the window and the drawing.
constexpr int kCoresOfOthers = 3;

/// The images of one patient.
class FluoroscopyRenderer final : public LiveRenderer<FluoroscopyTraits> {
 public:
  FluoroscopyRenderer(Fluoroscope fluoroscope, const std::atomic<bool>& is_pedal_down)
      : fluoroscope_(std::move(fluoroscope)), is_pedal_down_(is_pedal_down) {}

  bool is_held() override { return !is_pedal_down_.load(); }

  Result<FluoroscopyFrame> render(const FluoroscopyRequest& request, const Frame& frame) override {
    held_.reset();
    return fluoroscope_.frame(request, mix64(frame.number));
  }

  Result<std::optional<FluoroscopyFrame>> render_held(const FluoroscopyRequest& request, const Frame& frame) override {
    if (held_ && held_->display == request.display && held_->mode == request.mode) return std::nullopt;
    FluoroscopyRequest hold = request;
    hold.is_pedal_down = false;
    TROCAR_TRY(FluoroscopyFrame image, fluoroscope_.frame(hold, mix64(frame.number)));
    held_ = std::move(hold);
    if (image.dose.pulses == 0) return std::nullopt;
    return std::optional<FluoroscopyFrame>(std::move(image));
  }

 private:
  Fluoroscope fluoroscope_;
  const std::atomic<bool>& is_pedal_down_;
  std::optional<FluoroscopyRequest> held_;  ///< As which the held image was shown.
};

}  // namespace

bool FluoroscopySchedule::is_same(const FluoroscopyRequest& a, const FluoroscopyRequest& b) const noexcept {
  return a.arm == b.arm && a.filters == b.filters && a.dose_mode == b.dose_mode && a.pulses_per_s == b.pulses_per_s &&
         a.mode == b.mode && a.display == b.display && a.motion.is_same_place(b.motion);
}

double FluoroscopySchedule::work(const FluoroscopyRequest& request, Level) const noexcept {
  const double pixels = request.arm.pixels;
  return pixels * pixels;
}

struct LiveFluoroscope::Impl {
  explicit Impl(const LiveFluoroscopeOptions& given)
      : options(given), worker({.threads = given.threads, .nice = given.nice}, FluoroscopyTraits(given.pace)) {}

  LiveFluoroscopeOptions options;
  std::atomic<bool> is_pedal_down = false;  ///< Of the newest request; outlives the worker, whose renderer reads it.
  LiveWorker<FluoroscopyTraits> worker;
};

LiveFluoroscopeOptions default_live_fluoroscope_options() {
  LiveFluoroscopeOptions options;
  options.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()) - kCoresOfOthers);
  return options;
}

LiveFluoroscope::LiveFluoroscope(const LiveFluoroscopeOptions& options) : impl_(std::make_unique<Impl>(options)) {}

LiveFluoroscope::~LiveFluoroscope() = default;

void LiveFluoroscope::open(std::shared_ptr<const XrayVolume> volume) {
  Fluoroscope fluoroscope(std::move(volume), impl_->options.detector, impl_->options.limits);
  impl_->worker.open(std::make_unique<FluoroscopyRenderer>(std::move(fluoroscope), impl_->is_pedal_down));
}

void LiveFluoroscope::request(FluoroscopyRequest request) {
  if (!std::isfinite(request.time_s) || !request.motion.is_finite() || !(request.pulses_per_s > 0.0)) return;
  impl_->is_pedal_down = request.is_pedal_down;
  impl_->worker.request(std::move(request));
}

const Feed<FluoroscopyFrame>& LiveFluoroscope::frames() const noexcept {
  return impl_->worker.images();
}

std::optional<Error> LiveFluoroscope::error() const {
  return impl_->worker.error();
}

}  // namespace trocar::xray
