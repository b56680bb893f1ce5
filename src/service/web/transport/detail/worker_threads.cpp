#include "web/transport/detail/worker_threads.h"

#include <algorithm>
#include <utility>

#include "core/log.h"
#include "core/start_thread.h"

namespace trocar::web::detail {

WorkerThreads::Taken WorkerThreads::enqueue(std::function<void()> job) {
  std::unique_lock lock(mutex_);
  if (jobs_.size() >= free_ && threads_.size() < most_threads_) add_thread();
  if (threads_.empty()) {
    lock.unlock();
    job();
    return static_cast<Taken>(true);
  }
  jobs_.push_back(std::move(job));
  count_waiting();
  has_job_.notify_one();
  return static_cast<Taken>(true);
}

void WorkerThreads::add_thread() {
  auto thread = start_thread("connection", [this] { work(); });
  if (!thread) return log_warning("{}", thread.error().text());
  ++free_;
  threads_.push_back(*std::move(thread));
}

void WorkerThreads::shutdown() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  has_job_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void WorkerThreads::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    has_job_.wait(lock, [this] { return !jobs_.empty() || is_ending_; });
    if (jobs_.empty()) return;
    const std::function<void()> job = std::move(jobs_.front());
    jobs_.pop_front();
    --free_;
    count_waiting();
    lock.unlock();
    job();
    lock.lock();
    ++free_;
    count_waiting();
  }
}

void WorkerThreads::count_waiting() {
  waiting_ = static_cast<int>(jobs_.size() - std::min(jobs_.size(), free_));
}

}  // namespace trocar::web::detail
