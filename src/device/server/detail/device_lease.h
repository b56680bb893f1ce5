#pragma once

#include <atomic>
#include <cstdint>

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
