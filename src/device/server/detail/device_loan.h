#pragma once

#include <atomic>
#include <cstdint>

namespace trocar::server {

/// Lends the device of the real-time thread to the control thread. Every request has a ticket of its own, so that the
/// answer to an earlier request is never taken for that to a later one. One thread a side; no side ever waits here.
class DeviceLoan {
 public:
  /// What the real-time thread has seen at the beginning of a period.
  struct Request {
    std::uint64_t ticket = 0;
    bool is_open = false;  ///< The device is wanted, or is lent.
  };

  // Control thread.
  /// A new request. The device must not be touched before is_lent(ticket).
  std::uint64_t ask() noexcept { return asked_.fetch_add(1, std::memory_order_acq_rel) + 1; }
  bool is_lent(std::uint64_t ticket) const noexcept { return lent_.load(std::memory_order_acquire) == ticket; }
  /// Ends the request, granted or not.
  void give_back(std::uint64_t ticket) noexcept { returned_.store(ticket, std::memory_order_release); }

  // Real-time thread.
  Request look() const noexcept {
    const std::uint64_t ticket = asked_.load(std::memory_order_acquire);
    return {ticket, returned_.load(std::memory_order_acquire) < ticket};
  }
  /// The device is left alone until look() says that the request is no longer open.
  void lend(const Request& request) noexcept { lent_.store(request.ticket, std::memory_order_release); }

 private:
  std::atomic<std::uint64_t> asked_{0}, lent_{0}, returned_{0};
};

}  // namespace trocar::server
