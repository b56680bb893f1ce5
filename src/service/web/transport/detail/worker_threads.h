#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <list>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "web/transport/detail/httplib_include.h"

namespace trocar::web::detail {

/// Threads of a server, one a connection. A thread starts when all others are busy, up to a maximum; then connections
/// wait in a queue, and `waiting` counts them. If no thread can start, connections wait for those that run; without
/// one, the listening thread serves the connection itself.
class WorkerThreads final : public httplib::TaskQueue {
 public:
  WorkerThreads(std::size_t most_threads, std::atomic<int>& waiting) : most_threads_(most_threads), waiting_(waiting) {}

  /// void or bool, by the library's version. Every job is taken.
  using Taken = decltype(std::declval<httplib::TaskQueue&>().enqueue(std::function<void()>()));
  Taken enqueue(std::function<void()> job) override;
  /// Ends after all jobs, also those that wait.
  void shutdown() override;

 private:
  /// With the lock.
  void add_thread();
  void work();
  void count_waiting();

  const std::size_t most_threads_;
  std::atomic<int>& waiting_;
  std::mutex mutex_;
  std::condition_variable has_job_;
  std::list<std::function<void()>> jobs_;
  std::vector<std::thread> threads_;
  std::size_t free_ = 0;  ///< Threads without a job, also those that start.
  bool is_ending_ = false;
};

}  // namespace trocar::web::detail
