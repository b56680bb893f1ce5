#include "core/parallel.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <thread>

#include "core/progress.h"
#include "core/start_thread.h"

#ifdef TROCAR_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace trocar {
inline namespace core {

namespace {

#ifdef TROCAR_THREAD_SANITIZER
// TBB is compiled without the thread sanitizer, which therefore cannot know that work starts after the call and ends
// before the call returns. These calls declare it. This file with TBB's templates is compiled without the sanitizer,
// too (cmake/compiler.cmake).
class HandOver {
 public:
  HandOver() { __tsan_release(&given_); }
  ~HandOver() { __tsan_acquire(&done_); }

  template <class Work>
  void run(const Work& work) {
    struct Done {
      char& done;
      ~Done() { __tsan_release(&done); }
    } at_end{done_};
    __tsan_acquire(&given_);
    work();
  }

 private:
  char given_ = 0;
  char done_ = 0;
};
#else
struct HandOver {
  template <class Work>
  void run(const Work& work) {
    work();
  }
};
#endif

/// TBB throws in whatever thread wants work done, if its threads cannot start. Where the machine's cannot all start at
/// the first call, no thread besides the caller's ever works.
void prepare_threads() {
  using Control = oneapi::tbb::global_control;
  // Never freed: its destructor starts threads.
  static const Control* const alone = [] {
    const int others = static_cast<int>(std::thread::hardware_concurrency()) - 1;
    const bool can_start = check_threads_can_start("worker", others).has_value();
    return can_start ? nullptr : new Control(Control::max_allowed_parallelism, 1);
  }();
  static_cast<void>(alone);
}

/// Each call has a context of its own: otherwise TBB skips the parts of nested work without a word as soon as any part
/// of the work around it has thrown, and the nested call returns as if they were done.
constexpr auto kIsolated = oneapi::tbb::task_group_context::isolated;

}  // namespace

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  cancellation_point();
  using Range = oneapi::tbb::blocked_range<std::size_t>;
  prepare_threads();
  HandOver hand_over;
  const std::stop_token stop = cancellation_token();
  oneapi::tbb::task_group_context own(kIsolated);
  oneapi::tbb::parallel_for(
      Range(0, count, std::max<std::size_t>(grain, 1)),
      [&](const Range& part) {
        const CancellationScope scope(stop);
        // TBB's parts can take long: work that can be cancelled is done in up to four pieces.
        const std::size_t pieces =
            stop.stop_possible() ? std::clamp<std::size_t>(part.size() / part.grainsize(), 1, 4) : 1;
        const auto begin_of = [&](std::size_t piece) { return part.begin() + piece * part.size() / pieces; };
        for (std::size_t piece = 0; piece < pieces; ++piece) {
          cancellation_point();
          hand_over.run([&] { body(begin_of(piece), begin_of(piece + 1)); });
        }
      },
      own);
}

void run_on_threads(int most, const std::function<void()>& body) {
  prepare_threads();
  oneapi::tbb::task_arena arena(std::max(most, 1));
  HandOver hand_over;
  arena.execute([&, stop = cancellation_token()] {
    const CancellationScope scope(stop);
    hand_over.run(body);
  });
}

void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b) {
  prepare_threads();
  HandOver hand_over;
  const auto run = [&, stop = cancellation_token()](const std::function<void()>& work) {
    const CancellationScope scope(stop);
    hand_over.run(work);
  };
  oneapi::tbb::task_group_context own(kIsolated);
  oneapi::tbb::parallel_invoke([&] { run(a); }, [&] { run(b); }, own);
}

void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b, const std::function<void()>& c) {
  prepare_threads();
  HandOver hand_over;
  const auto run = [&, stop = cancellation_token()](const std::function<void()>& work) {
    const CancellationScope scope(stop);
    hand_over.run(work);
  };
  oneapi::tbb::task_group_context own(kIsolated);
  oneapi::tbb::parallel_invoke([&] { run(a); }, [&] { run(b); }, [&] { run(c); }, own);
}

}  // namespace core
}  // namespace trocar
