#pragma once

#include <functional>
#include <future>
#include <stop_token>
#include <string_view>
#include <system_error>
#include <thread>
#include <type_traits>

#include "core/progress.h"
#include "core/result.h"

namespace trocar {
inline namespace core {

/// Starts a thread. Only the functions of this file do: a thread's constructor throws if the system cannot create one
/// (a limit on processes or memory). `name` is for the message: "the NAME thread does not start". The body does not
/// throw.
Result<std::thread> start_thread(std::string_view name, std::function<void()> body);
/// The same for a thread that is stopped and joined when its owner destroys it.
Result<std::jthread> start_stoppable_thread(std::string_view name, std::function<void(const std::stop_token&)> body);

/// Checks that `count` more threads can run at a time, before a library starts them that would abort the program
/// (ZeroMQ). Another program may still take them in between.
Status check_threads_can_start(std::string_view name, int count);

/// Computes `work()` on a thread, or on this one before it returns if no thread can start. The future is that of
/// std::async: its destructor waits, and an exception of the work is thrown by get().
template <class Work>
std::future<std::invoke_result_t<const Work&>> compute_beside(const Work& work) {
  try {
    return std::async(std::launch::async, [work, stop = cancellation_token()] {
      const CancellationScope scope(stop);
      return work();
    });
  } catch (const std::system_error&) {
    std::packaged_task<std::invoke_result_t<const Work&>()> task(work);
    task();
    return task.get_future();
  }
}

}  // namespace core
}  // namespace trocar
