#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include "core/clock.h"
#include "core/live/feed.h"
#include "core/live/live_schedule.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/result.h"
#include "core/start_thread.h"

namespace trocar {
inline namespace core {

/// Parameters of the frame that a renderer makes.
template <class Level>
struct LiveFrame {
  Level level{};             ///< Level of detail; not used for a held image.
  std::uint64_t number = 1;  ///< Image number, counted by the worker over all its renderers.
  double begun_s = 0.0;      ///< Start time on the worker's clock.
  std::stop_token stop;      ///< Stop is requested if the image will not be used: a long render may end early.
};

/// Makes the images of one subject (a patient with a transducer, a C-arm), on the worker's thread only.
template <class Traits>
class LiveRenderer {
 public:
  using Request = typename Traits::Request;
  using Image = typename Traits::Image;
  using Frame = LiveFrame<typename Traits::Level>;

  virtual ~LiveRenderer() = default;
  virtual Result<Image> render(const Request& request, const Frame& frame) = 0;
  /// Called before each request: true while a held image is displayed (a frozen cine loop, a last-image hold), which
  /// needs no schedule.
  virtual bool is_held() { return false; }
  /// The held image, displayed as in the request; empty if it has not changed.
  virtual Result<std::optional<Image>> render_held(const Request&, const Frame&) { return std::optional<Image>{}; }
};

struct LiveWorkerOptions {
  int threads = 1;  ///< Threads of one frame. Range 1..64.
  int nice = 5;     ///< Added to the niceness of the worker's thread. Range 0..19.
  std::shared_ptr<const Clock> clock = std::make_shared<SteadyClock>();  ///< Read on the worker's thread.
};

/// A thread that makes live images. It takes the newest request and drops older ones; LiveSchedule decides from
/// measured times whether a frame is due and at which level of detail. It works only on request: a request that is not
/// due is dropped, so a client repeats its request, for example once per displayed frame. A failed render keeps the
/// last image; the next request tries again. All calls are for one client thread (images(): any); only the destructor
/// and wait_until_idle() wait for a frame.
///
/// `Traits`: as for LiveSchedule, and
///   using Image; static void stamp(Image&, std::uint64_t number, double took_ms): stores number and time in an image.
template <class Traits>
class LiveWorker {
 public:
  using Request = typename Traits::Request;
  using Image = typename Traits::Image;
  using Renderer = LiveRenderer<Traits>;

  explicit LiveWorker(LiveWorkerOptions options = {}, Traits traits = {})
      : options_(std::move(options)), schedule_(std::move(traits)) {}
  /// Requests the stop of a frame in work and waits for its end; a request that was not begun is dropped.
  ~LiveWorker() {
    {
      const std::lock_guard lock(mutex_);
      is_ending_ = true;
      stop_.request_stop();
    }
    wake_.notify_one();
    if (thread_.joinable()) thread_.join();
  }
  LiveWorker(const LiveWorker&) = delete;
  LiveWorker& operator=(const LiveWorker&) = delete;

  /// Opens another subject: the waiting request, the newest image and a frame in work are dropped. The worker's thread
  /// destroys the former renderer.
  void open(std::unique_ptr<Renderer> renderer) {
    const std::lock_guard lock(mutex_);  // the renderer that was never used is freed after it
    ++opened_;
    stop_.request_stop();
    stop_ = std::stop_source();
    fresh_.swap(renderer);
    request_.reset();
    error_.reset();
    images_.clear();
  }
  /// Starts the worker's thread if it does not run; error() tells that it cannot start.
  void request(Request request) {
    if (!thread_.joinable() && !has_started()) return;
    {
      const std::lock_guard lock(mutex_);
      request_ = std::move(request);
    }
    wake_.notify_one();
  }

  /// The images, for any thread; none before the first one of the subject.
  const Feed<Image>& images() const noexcept { return images_; }
  /// The error of the last frame, if its render failed, or of the worker's thread.
  std::optional<Error> error() const {
    const std::lock_guard lock(mutex_);
    return error_;
  }
  /// Returns when no request waits and no frame is in work. For tests and programs without a window.
  void wait_until_idle() const {
    std::unique_lock lock(mutex_);
    idle_.wait(lock, [&] { return !request_ && !is_working_; });
  }

 private:
  bool has_started() {
    auto thread = start_thread("image", [this] { run(); });
    const std::lock_guard lock(mutex_);
    if (thread) {
      thread_ = *std::move(thread);
    } else {
      note_error(std::move(thread).error());
    }
    return thread_.joinable();
  }

  struct Job {
    std::uint64_t opened = 0;
    Request request;
    std::stop_token stop;
  };

  double now_s() const { return seconds_between(Clock::TimePoint{}, options_.clock->now()); }

  void run() {
    lower_priority(options_.nice);
    while (const std::optional<Job> job = next_job())
      if (renderer_) run_on_threads(options_.threads, [&] { work(*job); });
  }

  std::optional<Job> next_job() {
    std::unique_ptr<Renderer> old;  // its buffers are freed after the lock
    std::unique_lock lock(mutex_);
    is_working_ = false;
    if (!request_) idle_.notify_all();
    wake_.wait(lock, [&] { return is_ending_ || request_; });
    if (is_ending_) return std::nullopt;
    is_working_ = true;
    if (fresh_) {
      old = std::exchange(renderer_, std::move(fresh_));
      schedule_.restart();
      was_held_ = false;
    }
    Job job{opened_, *std::move(request_), stop_.get_token()};
    request_.reset();
    lock.unlock();
    return job;
  }

  void work(const Job& job) {
    try {
      const bool is_held = renderer_->is_held();
      if (was_held_ && !is_held) schedule_.restart();
      was_held_ = is_held;
      is_held ? work_held(job) : work_live(job);
    } catch (const std::exception& error) {  // a library error or out of memory: this thread has no caller
      publish(job, fail("an image could not be computed", error.what(), "close other programs if memory is short"));
    } catch (...) {
      publish(job, fail("an image could not be computed", "unknown error", "try again; if it remains, report it"));
    }
  }

  void work_live(const Job& job) {
    LiveFrame<typename Traits::Level> frame{{}, number_ + 1, now_s(), job.stop};
    const auto level = schedule_.due(job.request, frame.begun_s);
    if (!level) return;
    frame.level = *level;
    Result<Image> made = renderer_->render(job.request, frame);
    const double took_ms = 1e3 * (now_s() - frame.begun_s);
    if (made && !job.stop.stop_requested()) schedule_.note_frame(job.request, *level, frame.begun_s, took_ms);
    publish(job, std::move(made), took_ms);
  }

  void work_held(const Job& job) {
    const double begun_s = now_s();
    Result<std::optional<Image>> kept = renderer_->render_held(job.request, {{}, number_ + 1, begun_s, job.stop});
    if (!kept) return publish(job, tl::unexpected(std::move(kept).error()));
    if (*kept) publish(job, **std::move(kept), 1e3 * (now_s() - begun_s));
  }

  void publish(const Job& job, Result<Image> made, double took_ms = 0.0) {
    std::shared_ptr<const Image> shared;
    if (made) {
      Traits::stamp(*made, ++number_, took_ms);
      shared = std::make_shared<const Image>(*std::move(made));
    }
    const std::lock_guard lock(mutex_);
    if (job.opened != opened_) return;  // of the former subject
    if (!made) return note_error(std::move(made).error());
    error_.reset();
    images_.publish(std::move(shared));
  }

  /// Under the mutex.
  void note_error(Error error) {
    if (!error_) log_warning("{}", error.text());
    error_ = std::move(error);
  }

  // Shared, under the mutex.
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  mutable std::condition_variable idle_;
  bool is_ending_ = false;
  bool is_working_ = false;
  std::uint64_t opened_ = 0;
  std::stop_source stop_;
  std::unique_ptr<Renderer> fresh_;  ///< Renderer of the subject opened last, until the worker takes it.
  std::optional<Request> request_;
  Feed<Image> images_;  ///< Written under the mutex: nothing of a former subject follows open().
  std::optional<Error> error_;

  // Used by the worker's thread only.
  LiveWorkerOptions options_;
  LiveSchedule<Traits> schedule_;
  std::unique_ptr<Renderer> renderer_;
  bool was_held_ = false;
  std::uint64_t number_ = 0;

  std::thread thread_;
};

}  // namespace core
}  // namespace trocar
