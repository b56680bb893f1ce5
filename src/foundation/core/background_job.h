#pragma once

#include <algorithm>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "core/start_thread.h"

namespace trocar {
inline namespace core {

/// Progress of a background job.
struct JobView {
  std::string step;       ///< Name of the present step.
  double fraction = 0.0;  ///< Progress, 0..1.
  bool is_done = false;   ///< The result is ready.
};

/// Work on a separate thread, which a cancellation ends at the next cancellation_point(), polled by a window once per
/// frame. Only the destructor blocks (see RetiredJobs). One thread owns the job; the work accesses only its Progress
/// and its stop token.
template <class T>
class BackgroundJob {
 public:
  /// No work: view().is_done is false and take() returns nothing.
  BackgroundJob() = default;
  /// Starts the work. `work` is `Result<T>(const Progress&)`, or `Result<T>(const Progress&, std::stop_token)` if it
  /// has something to do when it is cancelled. The result of a stopped job is always dropped. If no thread can start,
  /// or the work throws, the result is an error.
  template <class Work>
  requires(!std::is_same_v<std::remove_cvref_t<Work>, BackgroundJob>) explicit BackgroundJob(Work work)
      : state_(std::make_shared<State>()) {
    auto thread = start_stoppable_thread(
        "background", [state = state_, work = std::make_shared<Work>(std::move(work))](const std::stop_token& stop) {
          std::optional<Result<T>> result = run(*work, progress_to(state), stop);
          const std::lock_guard lock(state->mutex);
          if (!stop.stop_requested()) state->result = std::move(result);
          state->view.is_done = true;
        });
    if (thread) {
      thread_ = *std::move(thread);
    } else {
      state_->result = tl::unexpected(std::move(thread).error());
      state_->view.is_done = true;
    }
  }
  BackgroundJob(BackgroundJob&&) noexcept = default;
  BackgroundJob& operator=(BackgroundJob&&) noexcept = default;

  bool has_work() const noexcept { return state_ != nullptr; }
  JobView view() const {
    if (!state_) return {};
    const std::lock_guard lock(state_->mutex);
    return state_->view;
  }
  /// Cancels the job and returns at once. The work ends at its next cancellation_point().
  void cancel() noexcept { thread_.request_stop(); }
  bool is_cancelled() const noexcept { return thread_.get_stop_token().stop_requested(); }
  /// Returns the result once; empty before it is ready and for a cancelled job.
  std::optional<Result<T>> take() {
    if (!state_ || is_cancelled()) return std::nullopt;
    const std::lock_guard lock(state_->mutex);
    return std::exchange(state_->result, std::nullopt);
  }

 private:
  struct State {
    std::mutex mutex;
    JobView view;
    std::optional<Result<T>> result;
  };

  static Progress progress_to(const std::shared_ptr<State>& state) {
    return [state](std::string_view step, double fraction) {
      cancellation_point();
      const std::lock_guard lock(state->mutex);
      state->view.step = step;
      state->view.fraction = std::clamp(fraction, 0.0, 1.0);
    };
  }

  template <class Work>
  static Result<T> run(Work& work, const Progress& progress, const std::stop_token& stop) {
    const CancellationScope scope(stop);
    try {
      if constexpr (std::is_invocable_v<Work&, const Progress&, std::stop_token>) {
        return work(progress, stop);
      } else {
        return work(progress);
      }
    } catch (const Cancelled&) {
      return fail("cancelled", {}, "start it again");  // dropped: the job was stopped
    } catch (const std::bad_alloc&) {
      return fail("not enough memory", {}, "close other programs, or use smaller data");
    } catch (const std::exception& error) {  // of a library: this thread has no caller
      return unforeseen(error.what());
    } catch (...) {
      return unforeseen("unknown");
    }
  }

  static Result<T> unforeseen(const char* what) {
    return fail(std::string("unforeseen error: ").append(what), {}, "try again; if it remains, report it");
  }

  std::shared_ptr<State> state_;
  std::jthread thread_;
};

/// Keeps cancelled jobs until their work ends, so that their owner does not block. The destructor waits for the rest.
class RetiredJobs {
 public:
  template <class T>
  void retire(BackgroundJob<T> job) {
    if (!job.has_work()) return;
    job.cancel();
    jobs_.push_back(std::make_unique<Retired<T>>(std::move(job)));
  }
  /// Removes the jobs that have ended; call it regularly. Returns the number of running ones.
  std::size_t sweep() {
    std::erase_if(jobs_, [](const std::unique_ptr<Any>& job) { return job->is_done(); });
    return jobs_.size();
  }

 private:
  struct Any {
    virtual ~Any() = default;
    virtual bool is_done() const = 0;
  };
  template <class T>
  struct Retired final : Any {
    explicit Retired(BackgroundJob<T> retired) : job(std::move(retired)) {}
    bool is_done() const override { return job.view().is_done; }
    BackgroundJob<T> job;
  };
  std::vector<std::unique_ptr<Any>> jobs_;
};

}  // namespace core
}  // namespace trocar
