#include "views/xray/replay_fluoroscope.h"

#include <cmath>
#include <limits>
#include <utility>

#include "attempt/record/xray_replay.h"
#include "core/files/folders.h"
#include "core/live/live_worker.h"
#include "core/log.h"
#include "core/random.h"

namespace trocar::trainer {

/// An image depends on its request only: it is not refreshed. Not in the anonymous namespace: a member of Impl uses it.
struct ReplayTraits {
  using Request = ReplayXrayRequest;
  using Level = xray::FluoroscopySchedule::Level;
  using Image = xray::FluoroscopyFrame;
  static constexpr std::size_t kLevels = xray::FluoroscopySchedule::kLevels;

  LivePace pace() const noexcept { return live.pace(); }
  bool is_same(const Request& a, const Request& b) const noexcept {
    return a.image_s == b.image_s && live.is_same(a.scene, b.scene);
  }
  double work(const Request& request, Level level) const noexcept { return live.work(request.scene, level); }
  double refresh_s(const Request&) const noexcept { return std::numeric_limits<double>::infinity(); }
  static void stamp(Image& image, std::uint64_t number, double took_ms) noexcept {
    image.number = number;
    image.took_ms = took_ms;
  }

  xray::FluoroscopySchedule live;
};

namespace {

class ReplayRenderer final : public LiveRenderer<ReplayTraits> {
 public:
  ReplayRenderer(ReplayXraySource source, const xray::LiveFluoroscopeOptions& options)
      : source_(std::move(source)), fluoroscope_(source_.volume, options.detector, options.limits) {}

  Result<xray::FluoroscopyFrame> render(const ReplayXrayRequest& request, const Frame& frame) override {
    xray::FluoroscopyRequest scene = request.scene;
    scene.iodine = iodine_at(request.image_s, frame.stop);
    if (request.is_injecting && !scene.tools.empty()) scene.tools.front().filling_iodine_mg_per_ml = agent_mg_per_ml_;
    if (!goes_on(request)) {
      // The pedal goes up: no lag and no grayscale of another moment.
      scene.is_pedal_down = false;
      scene.time_s = clock_s_;
      TROCAR_TRY_STATUS(fluoroscope_.frame(scene, 0));
    }
    clock_s_ += kPulsesAStep / scene.pulses_per_s;
    scene.is_pedal_down = true;
    scene.time_s = clock_s_;
    // The same moment has the same noise.
    const auto seed = mix64(static_cast<std::uint64_t>(std::llround(1e6 * std::abs(request.image_s))));
    TROCAR_TRY(xray::FluoroscopyFrame image, fluoroscope_.frame(scene, seed));
    image.time_s = request.image_s;
    last_s_ = request.image_s;
    return image;
  }

 private:
  /// Surely one pulse, in spite of rounding.
  static constexpr double kPulsesAStep = 1.5;

  /// True for the pulses after the last one, as in a replay that plays.
  bool goes_on(const ReplayXrayRequest& request) const {
    constexpr double kMostPulses = 4.0;
    const double passed_s = request.image_s - last_s_;
    return passed_s > 0.0 && passed_s < kMostPulses / request.scene.pulses_per_s;
  }

  std::shared_ptr<const xray::Iodine> iodine_at(double time_s, const std::stop_token& stop) {
    if (source_.injections->steps.empty() || time_s < source_.injections->start_s) return nullptr;
    if (!contrast_ && !has_failed_) {
      const Status made = make_contrast();
      has_failed_ = !made;
      if (!made) log_warning("no contrast agent in the replay: {}", made.error().text());
    }
    return contrast_ ? contrast_->at(time_s, stop) : nullptr;
  }

  Status make_contrast() {
    TROCAR_TRY(const xray::ContrastTable table, xray::load_contrast_table(data_dir() / "contrast.toml"));
    TROCAR_TRY(xray::ContrastFlow flow, xray::ContrastFlow::make(source_.patient, table, source_.blood));
    agent_mg_per_ml_ = table.iodine_mg_per_ml;
    contrast_.emplace(std::move(flow), source_.injections, agent_mg_per_ml_);
    return {};
  }

  ReplayXraySource source_;
  xray::Fluoroscope fluoroscope_;
  std::optional<attempt::ContrastReplay> contrast_;
  bool has_failed_ = false;
  double agent_mg_per_ml_ = 0.0;
  double clock_s_ = 0.0;                                      ///< Time for the fluoroscope, which never goes back.
  double last_s_ = -std::numeric_limits<double>::infinity();  ///< Session time of the last image.
};

}  // namespace

struct ReplayFluoroscope::Impl {
  explicit Impl(const xray::LiveFluoroscopeOptions& options)
      : worker({.threads = options.threads, .nice = options.nice}, {xray::FluoroscopySchedule(options.pace)}) {}
  LiveWorker<ReplayTraits> worker;
};

ReplayFluoroscope::ReplayFluoroscope(ReplayXraySource source, const xray::LiveFluoroscopeOptions& options)
    : impl_(std::make_unique<Impl>(options)) {
  impl_->worker.open(std::make_unique<ReplayRenderer>(std::move(source), options));
}

ReplayFluoroscope::~ReplayFluoroscope() = default;

void ReplayFluoroscope::request(ReplayXrayRequest request) {
  impl_->worker.request(std::move(request));
}

const Feed<xray::FluoroscopyFrame>& ReplayFluoroscope::frames() const noexcept {
  return impl_->worker.images();
}

std::optional<Error> ReplayFluoroscope::error() const {
  return impl_->worker.error();
}

}  // namespace trocar::trainer
