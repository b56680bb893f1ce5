#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/log.h"
#include "link/messages.h"
#include "realtime/lock_free.h"
#include "realtime/loop_statistics.h"
#include "realtime/periodic_loop.h"
#include "server/crash_handler.h"
#include "server/servo.h"
#include "server/servo_commands.h"

namespace trocar::server {

/// Lends the device of the real-time thread to the control thread. Every request has its own ticket, so that a late
/// answer to an earlier request does not count for a later one. One thread per side; no call blocks.
class DeviceLease {
 public:
  /// State of the lease at the beginning of a period of the real-time thread.
  struct Request {
    std::uint64_t ticket = 0;
    bool is_open = false;  ///< The device is requested or leased.
  };

  // Control thread.
  /// Starts a new request and returns its ticket. Do not access the device before is_leased(ticket).
  std::uint64_t ask() noexcept { return asked_.fetch_add(1, std::memory_order_acq_rel) + 1; }
  bool is_leased(std::uint64_t ticket) const noexcept { return leased_.load(std::memory_order_acquire) == ticket; }
  /// Ends the request, whether it was granted or not.
  void give_back(std::uint64_t ticket) noexcept { returned_.store(ticket, std::memory_order_release); }

  // Real-time thread.
  Request look() const noexcept {
    const std::uint64_t ticket = asked_.load(std::memory_order_acquire);
    return {ticket, returned_.load(std::memory_order_acquire) < ticket};
  }
  /// Grants the request. The real-time thread must not access the device until look() returns that it is not open.
  void grant(const Request& request) noexcept { leased_.store(request.ticket, std::memory_order_release); }

 private:
  std::atomic<std::uint64_t> asked_{0}, leased_{0}, returned_{0};
};

}  // namespace trocar::server

/// Data shared by the three threads of a haptic server. Private to `server`.
namespace trocar::server {

/// The records of the last seconds before a fault, to be written.
using Flight = std::vector<ServoRecord>;
/// Work for the control thread.
struct ControlJob {
  std::uint64_t session = 0;  ///< Session that gets the reply; 0: none.
  std::uint32_t request = 0;
  std::variant<link::LoadScene, link::SetParameters, link::ServerCommand, Flight> what;
};
/// Bytes of the texts and tissue settings in the client's message.
std::size_t text_bytes(const ControlJob& job);

struct AddressedReply {
  std::uint64_t session = 0;
  link::Reply reply;
};

/// Status that the control thread sets and the link thread sends.
struct ControlStatus {
  std::string patient, patient_hash, force_model, task, warning;
  bool has_scene = false;
  double loading = 0.0;  ///< 0: nothing is being loaded.
};

/// Limits of the job queue of the control thread: number of jobs, and bytes of their texts. [assumed]
inline constexpr std::size_t kMostJobs = 16;
inline constexpr std::size_t kMostJobBytes = 4 << 20;
/// Flight records wait in a queue of their own, which clients cannot fill with jobs. [assumed]
inline constexpr std::size_t kMostFlights = 4;

/// Queues between the link thread and the control thread. Both threads may block; neither is the real-time thread. The
/// job queue is bounded.
class ControlQueue {
 public:
  /// Queues a job. Returns false, and does not queue it, if kMostJobs or kMostJobBytes would be exceeded. A newer scene
  /// stops the loading of an older one.
  bool post(ControlJob job) {
    {
      const std::lock_guard lock(mutex_);
      const std::size_t bytes = text_bytes(job);
      if (jobs_.size() >= kMostJobs || bytes_ + bytes > kMostJobBytes) return false;
      bytes_ += bytes;
      if (std::holds_alternative<link::LoadScene>(job.what)) running_.request_stop();
      jobs_.push_back(std::move(job));
    }
    wake_.notify_one();
    return true;
  }
  /// Queues a flight record, before all jobs. Returns false, and does not queue it, if kMostFlights wait.
  bool post(Flight flight) {
    {
      const std::lock_guard lock(mutex_);
      if (flights_.size() >= kMostFlights) return false;
      flights_.push_back(std::move(flight));
    }
    wake_.notify_one();
    return true;
  }
  /// Takes the flight records that no job has written, at the end of the server.
  std::deque<Flight> take_flights() {
    const std::lock_guard lock(mutex_);
    return std::exchange(flights_, {});
  }
  /// Waits for the next job. Returns false after close().
  bool wait(ControlJob& job) {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [&] { return is_closed_ || !jobs_.empty() || !flights_.empty(); });
    if (is_closed_) return false;
    if (!flights_.empty()) {
      job = {0, 0, std::move(flights_.front())};
      flights_.pop_front();
      return true;
    }
    job = std::move(jobs_.front());
    jobs_.pop_front();
    bytes_ -= text_bytes(job);
    running_ = std::stop_source();
    const auto is_scene = [](const ControlJob& later) { return std::holds_alternative<link::LoadScene>(later.what); };
    if (std::any_of(jobs_.begin(), jobs_.end(), is_scene)) running_.request_stop();
    return true;
  }
  /// Stop token of the job that wait() returned last. Its stop is requested when a newer scene is posted or after
  /// close().
  std::stop_token stop_token() const {
    const std::lock_guard lock(mutex_);
    return running_.get_token();
  }
  void close() {
    {
      const std::lock_guard lock(mutex_);
      is_closed_ = true;
      running_.request_stop();
    }
    wake_.notify_all();
  }
  void answer(AddressedReply reply) {
    const std::lock_guard lock(mutex_);
    replies_.push_back(std::move(reply));
  }
  std::vector<AddressedReply> take_replies() {
    const std::lock_guard lock(mutex_);
    return std::exchange(replies_, {});
  }
  ControlStatus status() const {
    const std::lock_guard lock(mutex_);
    return status_;
  }
  template <class Change>
  void update(Change&& change) {
    const std::lock_guard lock(mutex_);
    change(status_);
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<ControlJob> jobs_;
  std::deque<Flight> flights_;
  std::stop_source running_;
  std::size_t bytes_ = 0;  ///< Sum of text_bytes() of jobs_.
  std::vector<AddressedReply> replies_;
  ControlStatus status_;
  bool is_closed_ = false;
};

inline constexpr std::size_t kRecordsKept = 8192;  // 2 s at 4 kHz
inline constexpr double kNeverHeard_s = 1e6;

/// The newest hand. A placement is counted, so that a later target before the next period does not hide it.
struct CountedHand {
  link::HandTarget target;
  std::uint64_t placements = 0;  ///< Targets with is_placed so far.
  double pressed_mm = 0.0;       ///< Of the last of them.
};

/// Data exchanged between the threads, grouped by direction.
struct Shared {
  explicit Shared(std::int64_t period) : period_ns(period), statistics(realtime::LoopStatistics(period)) {}

  const std::int64_t period_ns;
  CrashHandler* crash_handler = nullptr;  ///< Crash handler of the device; outlives the threads.
  std::atomic<bool> is_stopping{false};
  std::atomic<bool> is_fading{false};  ///< True before the server stops: forces off.

  // From the link thread to the real-time thread.
  CommandQueue commands;
  realtime::TripleBuffer<CountedHand> hand;
  std::atomic<std::int64_t> heard_ns{0};  ///< Time of the last message of the client in control; 0: no such client.

  // From the real-time thread to the link thread.
  realtime::SpscRing<ServoRecord> records{kRecordsKept};
  std::atomic<std::uint64_t> records_dropped{0};
  realtime::TripleBuffer<realtime::LoopStatistics> statistics;
  std::atomic<bool> is_wanted{false};
  StopStatistics stops;  ///< Written by the real-time thread at its end.
  std::atomic<bool> has_grant{false};
  realtime::RealTimeGrant grant;  ///< Written before has_grant is set.

  // Between the control thread and the real-time thread.
  realtime::Handover<ServoScene> scene;
  DeviceLease lease;  ///< Lease of the device to the control thread.

  // Between the link thread and the control thread.
  ControlQueue control_queue;
  std::shared_ptr<LogLimit> log_limit = std::make_shared<LogLimit>();  ///< Of log lines that clients can cause.
};

/// Function of the real-time thread.
void run_servo_thread(Shared& shared, Servo& servo, int priority) noexcept;

}  // namespace trocar::server
