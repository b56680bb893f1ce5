#include "ultrasound/live/live_scanner.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "core/live/live_worker.h"
#include "core/random.h"
#include "ultrasound/live/picture_maker.h"

namespace trocar::ultrasound {
namespace {

/// Cores for two servers' loops, the window and the drawing.
constexpr int kCoresOfOthers = 3;

bool is_finite(const ScanRequest& request) noexcept {
  return request.X_PT.is_finite() && std::isfinite(request.time_s) &&
         std::all_of(request.needle_shaft_P.begin(), request.needle_shaft_P.end(),
                     [](const Vec3& p_P) { return p_P.allFinite(); });
}

}  // namespace

struct LiveScanner::Impl {
  /// How LiveWorker makes ultrasound images.
  struct ScanTraits : ScanLevels {
    using ScanLevels::ScanLevels;
    using Image = ScanPicture;
    static void stamp(ScanPicture& picture, std::uint64_t number, double took_ms) noexcept {
      picture.number = number;
      picture.took_ms = took_ms;
    }
  };

  /// Commands to the cine loop that the renderer has not executed yet.
  struct CineCommands {
    bool is_frozen = false;
    bool is_playing = false;
    int steps = 0;
    std::optional<int> index;
  };

  /// CineCommands from the client's thread to the worker's.
  class CineControls {
   public:
    template <class Change>
    void change(const Change& change) {
      const std::lock_guard lock(mutex_);
      change(commands_);
    }
    CineCommands commands() const {
      const std::lock_guard lock(mutex_);
      return commands_;
    }
    /// Steps are executed once, the rest stays in force.
    CineCommands take() {
      const std::lock_guard lock(mutex_);
      CineCommands taken = commands_;
      commands_.steps = 0;
      commands_.index.reset();
      return taken;
    }

   private:
    mutable std::mutex mutex_;
    CineCommands commands_;
  };

  /// The images of one patient and transducer, live or from the frozen cine loop.
  class ScanRenderer final : public LiveRenderer<ScanTraits> {
   public:
    ScanRenderer(PictureMaker maker, CineControls& controls) : maker_(std::move(maker)), controls_(controls) {}

    bool is_held() override {
      commands_ = controls_.take();
      CineLoop* const cine = maker_.cine();
      if (cine == nullptr) return false;
      if (!commands_.is_frozen && cine->is_frozen()) {
        cine->thaw();
        kept_request_.reset();
      }
      if (commands_.is_frozen) cine->freeze();
      return commands_.is_frozen;
    }

    Result<ScanPicture> render(const ScanRequest& request, const Frame& frame) override {
      return with_cine(maker_.make(request, frame.level, mix64(frame.number)));
    }

    Result<std::optional<ScanPicture>> render_held(const ScanRequest& request, const Frame& frame) override {
      CineLoop& cine = *maker_.cine();
      if (commands_.index) cine.step(*commands_.index - cine.position());
      if (commands_.steps != 0) cine.step(commands_.steps);
      if (commands_.is_playing) cine.play(std::max(0.0, frame.begun_s - played_s_));
      played_s_ = frame.begun_s;
      const bool is_shown =
          kept_request_ && has_same_settings(*kept_request_, request) && kept_position_ == cine.position();
      if (is_shown) return std::nullopt;
      kept_request_ = request;
      kept_position_ = cine.position();
      return with_cine(maker_.show_kept(request));
    }

   private:
    ScanPicture with_cine(ScanPicture picture) {
      picture.cine_position = maker_.cine()->position();
      picture.cine_size = maker_.cine()->size();
      return picture;
    }

    PictureMaker maker_;
    CineControls& controls_;
    CineCommands commands_;                    ///< Of the request in work.
    std::optional<ScanRequest> kept_request_;  ///< With which the frozen picture was shown.
    int kept_position_ = -1;
    double played_s_ = 0.0;
  };

  explicit Impl(const LiveScannerOptions& options)
      : worker({.threads = options.threads, .nice = options.nice}, ScanTraits(options.pace)) {}

  CineControls cine;  ///< Outlives the worker, whose renderer reads it.
  LiveWorker<ScanTraits> worker;
};

LiveScannerOptions default_live_scanner_options() {
  LiveScannerOptions options;
  options.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()) - kCoresOfOthers);
  return options;
}

LiveScanner::LiveScanner(const LiveScannerOptions& options) : impl_(std::make_unique<Impl>(options)) {}

LiveScanner::~LiveScanner() = default;

void LiveScanner::open(std::shared_ptr<const AcousticScene> scene, Transducer transducer) {
  PictureMaker maker(std::move(scene), std::move(transducer));
  impl_->cine.change([](Impl::CineCommands& commands) { commands = {}; });
  impl_->worker.open(std::make_unique<Impl::ScanRenderer>(std::move(maker), impl_->cine));
}

void LiveScanner::request(ScanRequest request) {
  if (is_finite(request)) impl_->worker.request(std::move(request));
}

const Feed<ScanPicture>& LiveScanner::pictures() const noexcept {
  return impl_->worker.images();
}

void LiveScanner::set_frozen(bool is_frozen) {
  if (is_frozen && !pictures().value()) return;
  impl_->cine.change([&](Impl::CineCommands& commands) {
    commands = {};
    commands.is_frozen = is_frozen;
  });
}

void LiveScanner::step_cine(int frames) {
  impl_->cine.change([&](Impl::CineCommands& commands) {
    if (!commands.is_frozen) return;
    commands.steps += std::clamp(frames, -PictureMaker::kCineFrames, PictureMaker::kCineFrames);
    commands.is_playing = false;
  });
}

void LiveScanner::show_cine(int index) {
  impl_->cine.change([&](Impl::CineCommands& commands) {
    if (!commands.is_frozen) return;
    commands.index = std::clamp(index, 0, PictureMaker::kCineFrames);
    commands.steps = 0;
    commands.is_playing = false;
  });
}

void LiveScanner::play_cine(bool is_playing) {
  impl_->cine.change([&](Impl::CineCommands& commands) {
    if (commands.is_frozen) commands.is_playing = is_playing;
  });
}

CineState LiveScanner::cine() const {
  const Impl::CineCommands commands = impl_->cine.commands();
  CineState state;
  state.is_frozen = commands.is_frozen;
  state.is_playing = commands.is_playing;
  if (const auto picture = pictures().value()) {
    state.position = picture->cine_position;
    state.size = picture->cine_size;
  }
  return state;
}

}  // namespace trocar::ultrasound
