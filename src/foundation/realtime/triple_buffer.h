#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace trocar::realtime {

/// Passes the newest value from one writing thread to one reading thread without blocking. T is copied; for real-time
/// use its copy must not allocate. Invariant: writing_, reading_ and between_ are three different slots.
template <class T>
class TripleBuffer {
 public:
  TripleBuffer() = default;
  explicit TripleBuffer(const T& initial) { slots_.fill({initial}); }
  TripleBuffer(const TripleBuffer&) = delete;
  TripleBuffer& operator=(const TripleBuffer&) = delete;

  /// Called by the writer only.
  void write(const T& value) noexcept {
    slots_[writing_].value = value;
    writing_ = between_.exchange(static_cast<std::uint8_t>(writing_ | kIsNew), std::memory_order_acq_rel) & kSlot;
  }

  /// Called by the reader only: true if a value was written since the last call.
  bool update() noexcept {
    if ((between_.load(std::memory_order_relaxed) & kIsNew) == 0) return false;
    reading_ = between_.exchange(reading_, std::memory_order_acq_rel) & kSlot;
    return true;
  }
  /// The value of the last update; the initial value before the first one.
  const T& value() const noexcept { return slots_[reading_].value; }
  const T& newest() noexcept {
    update();
    return value();
  }

 private:
  static constexpr std::uint8_t kSlot = 3;
  static constexpr std::uint8_t kIsNew = 4;
  struct alignas(64) Slot {
    T value{};
  };
  std::array<Slot, 3> slots_{};
  std::uint8_t writing_ = 0;
  std::atomic<std::uint8_t> between_{1};
  std::uint8_t reading_ = 2;
};

}  // namespace trocar::realtime
