#include "ultrasound/live/live_scanner.h"

#ifdef __linux__
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "core/parallel.h"
#include "core/random.h"
#include "ultrasound/live/picture_maker.h"

namespace trocar::ultrasound {
namespace {

/// Cores for two servers' loops, the window and the drawing.
constexpr int kCoresOfOthers = 3;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Lowers the priority of the calling thread, as far as permitted.
void give_way(int nice) {
#ifdef __linux__
  const auto thread = static_cast<id_t>(::syscall(SYS_gettid));
  (void)::setpriority(PRIO_PROCESS, thread, ::getpriority(PRIO_PROCESS, thread) + nice);
#else
  (void)nice;
#endif
}

bool is_finite(const ScanRequest& request) noexcept {
  return request.X_PT.is_finite() && std::isfinite(request.time_s) &&
         std::all_of(request.needle_shaft_P.begin(), request.needle_shaft_P.end(),
                     [](const Vec3& p_P) { return p_P.allFinite(); });
}

/// The window's requests for the cine loop.
struct CineWish {
  bool is_frozen = false;
  bool is_playing = false;
  int steps = 0;
  std::optional<int> index;
};

}  // namespace

struct LiveScanner::Impl {
  explicit Impl(const LiveScannerOptions& how) : options(how), schedule(how.pace) {}

  // Shared, protected by the mutex.
  mutable std::mutex mutex;
  std::condition_variable wake;
  bool is_ending = false;
  std::uint64_t opened = 0;
  std::optional<PictureMaker> fresh_maker;
  std::optional<ScanRequest> wanted;
  bool is_wanted_new = false;
  CineWish wish;
  CineState state;
  std::shared_ptr<const ScanPicture> picture;

  // Used by the worker only.
  LiveScannerOptions options;
  std::optional<PictureMaker> maker;
  ScanSchedule schedule;
  std::optional<ScanRequest> kept_request;  ///< Request for which the frozen image was drawn.
  int kept_position = -1;
  double played_s = 0.0;
  std::uint64_t number = 0;

  std::thread thread;

  /// Task of the worker.
  struct Task {
    std::uint64_t opened = 0;
    ScanRequest request;
    CineWish wish;
  };
  std::optional<Task> next_task();
  void run();
  void work(const Task& task);
  void work_live(const Task& task);
  void work_frozen(const Task& task);
  void publish(const Task& task, ScanPicture made, double begun_s);
};

std::optional<LiveScanner::Impl::Task> LiveScanner::Impl::next_task() {
  std::optional<PictureMaker> old_maker;
  std::unique_lock lock(mutex);
  wake.wait(lock, [&] { return is_ending || is_wanted_new; });
  if (is_ending) return std::nullopt;
  is_wanted_new = false;
  if (fresh_maker) {
    old_maker = std::exchange(maker, std::move(fresh_maker));
    fresh_maker.reset();
    schedule.restart();
    kept_request.reset();
  }
  Task task{opened, *wanted, wish};
  wish.steps = 0;
  wish.index.reset();
  lock.unlock();  // before the buffers of the old maker are released
  return task;
}

void LiveScanner::Impl::run() {
  give_way(options.nice);
  while (const std::optional<Task> task = next_task()) {
    if (maker) run_on_threads(options.threads, [&] { work(*task); });
  }
}

void LiveScanner::Impl::work(const Task& task) {
  CineLoop* const cine = maker->cine();
  if (task.wish.is_frozen && cine != nullptr) {
    cine->freeze();
    work_frozen(task);
    return;
  }
  if (cine != nullptr && cine->is_frozen()) {
    cine->thaw();
    schedule.restart();
    kept_request.reset();
  }
  work_live(task);
}

void LiveScanner::Impl::work_live(const Task& task) {
  const double begun_s = now_s();
  const std::optional<ScanDetail> detail = schedule.due(task.request, begun_s);
  if (!detail) return;
  ScanPicture made = maker->make(task.request, *detail, mix64(number + 1));
  schedule.note_frame(task.request, *detail, begun_s, 1e3 * (now_s() - begun_s));
  publish(task, std::move(made), begun_s);
}

void LiveScanner::Impl::work_frozen(const Task& task) {
  CineLoop& cine = *maker->cine();
  const double begun_s = now_s();
  if (task.wish.index) cine.step(*task.wish.index - cine.position());
  if (task.wish.steps != 0) cine.step(task.wish.steps);
  if (task.wish.is_playing) cine.play(std::max(0.0, begun_s - played_s));
  played_s = begun_s;
  const bool is_shown =
      kept_request && has_same_settings(*kept_request, task.request) && kept_position == cine.position();
  if (is_shown) return;
  kept_request = task.request;
  kept_position = cine.position();
  publish(task, maker->show_kept(task.request), begun_s);
}

void LiveScanner::Impl::publish(const Task& task, ScanPicture made, double begun_s) {
  made.took_ms = 1e3 * (now_s() - begun_s);
  made.number = ++number;
  const CineLoop& cine = *maker->cine();
  auto shared = std::make_shared<const ScanPicture>(std::move(made));
  const std::lock_guard lock(mutex);
  if (task.opened != opened) return;  // of the previous patient
  picture.swap(shared);
  state.position = cine.position();
  state.size = cine.size();
}

LiveScannerOptions default_live_scanner_options() {
  LiveScannerOptions options;
  options.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()) - kCoresOfOthers);
  return options;
}

LiveScanner::LiveScanner(const LiveScannerOptions& options) : impl_(std::make_unique<Impl>(options)) {
  impl_->thread = std::thread([impl = impl_.get()] { impl->run(); });
}

LiveScanner::~LiveScanner() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->is_ending = true;
  }
  impl_->wake.notify_one();
  impl_->thread.join();
}

void LiveScanner::open(std::shared_ptr<const AcousticScene> scene, std::shared_ptr<const VesselFlow> flow,
                       Transducer transducer) {
  PictureMaker maker(std::move(scene), std::move(flow), std::move(transducer));
  std::shared_ptr<const ScanPicture> old;
  const std::lock_guard lock(impl_->mutex);
  ++impl_->opened;
  impl_->fresh_maker = std::move(maker);
  impl_->wanted.reset();
  impl_->is_wanted_new = false;
  impl_->wish = {};
  impl_->state = {};
  old.swap(impl_->picture);
}

void LiveScanner::request(ScanRequest request) {
  if (!is_finite(request)) return;
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->wanted = std::move(request);
    impl_->is_wanted_new = true;
  }
  impl_->wake.notify_one();
}

std::shared_ptr<const ScanPicture> LiveScanner::newest() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->picture;
}

void LiveScanner::set_frozen(bool is_frozen) {
  const std::lock_guard lock(impl_->mutex);
  if (is_frozen && !impl_->picture) return;
  impl_->wish = {};
  impl_->wish.is_frozen = is_frozen;
  impl_->state.is_frozen = is_frozen;
  impl_->state.is_playing = false;
}

void LiveScanner::step_cine(int frames) {
  const std::lock_guard lock(impl_->mutex);
  if (!impl_->wish.is_frozen) return;
  impl_->wish.steps += std::clamp(frames, -PictureMaker::kCineFrames, PictureMaker::kCineFrames);
  impl_->wish.is_playing = impl_->state.is_playing = false;
}

void LiveScanner::show_cine(int index) {
  const std::lock_guard lock(impl_->mutex);
  if (!impl_->wish.is_frozen) return;
  impl_->wish.index = std::clamp(index, 0, PictureMaker::kCineFrames);
  impl_->wish.steps = 0;
  impl_->wish.is_playing = impl_->state.is_playing = false;
}

void LiveScanner::play_cine(bool is_playing) {
  const std::lock_guard lock(impl_->mutex);
  if (!impl_->wish.is_frozen) return;
  impl_->wish.is_playing = impl_->state.is_playing = is_playing;
}

CineState LiveScanner::cine() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->state;
}

}  // namespace trocar::ultrasound
