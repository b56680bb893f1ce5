#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace trocar::realtime {

/// Immutable objects built by one thread and used by a real-time thread: the builder calls publish and collect, the
/// user acquire. The user never frees memory. Invariant: `kept_` contains all objects that the user may still read.
template <class T>
class Handover {
 public:
  Handover() = default;
  Handover(const Handover&) = delete;
  Handover& operator=(const Handover&) = delete;

  /// Called by the builder: sets the object for all later acquires. null: no object.
  void publish(std::shared_ptr<const T> object) {
    offered_.store(object.get(), std::memory_order_seq_cst);
    kept_.push_back(std::move(object));
    collect();
  }
  /// Called regularly by the builder: frees objects that the user can no longer read.
  void collect() {
    const T* offered = offered_.load(std::memory_order_seq_cst);
    const T* trying = trying_.load(std::memory_order_seq_cst);
    const T* used = used_.load(std::memory_order_seq_cst);
    std::erase_if(kept_, [&](const auto& object) {
      return object.get() != offered && object.get() != used && object.get() != trying;
    });
  }
  /// Called by the user once per period: the object is valid until the next acquire. Real-time safe.
  const T* acquire() noexcept {
    // Announces the candidate before checking again that it is still offered, so that collect() cannot free it in
    // between.
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const T* object = offered_.load(std::memory_order_seq_cst);
      if (object == current_) return current_;
      trying_.store(object, std::memory_order_seq_cst);
      if (offered_.load(std::memory_order_seq_cst) != object) continue;
      current_ = object;
      used_.store(object, std::memory_order_seq_cst);
      return current_;
    }
    return current_;
  }

 private:
  static constexpr int kAttempts = 4;
  std::atomic<const T*> offered_{nullptr};
  std::atomic<const T*> used_{nullptr};
  std::atomic<const T*> trying_{nullptr};
  const T* current_ = nullptr;  ///< Accessed by the user only.
  std::vector<std::shared_ptr<const T>> kept_;
};

/// Queue that passes every value, in order, from one writing thread to one reading thread. The constructor allocates
/// (and touches) its memory. Invariant: head - tail is at most the capacity.
template <class T>
class SpscRing {
 public:
  /// `capacity` is rounded up to a power of two.
  explicit SpscRing(std::size_t capacity) : slots_(std::bit_ceil(capacity < 2 ? std::size_t{2} : capacity)) {}
  SpscRing(const SpscRing&) = delete;
  SpscRing& operator=(const SpscRing&) = delete;

  std::size_t capacity() const noexcept { return slots_.size(); }
  std::size_t size() const noexcept {
    return head_.load(std::memory_order_acquire) - tail_.load(std::memory_order_acquire);
  }

  /// Called by the writer only. False: the ring is full and the value was not stored.
  bool push(const T& value) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) == slots_.size()) return false;
    slots_[head & (slots_.size() - 1)] = value;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }
  /// Called by the reader only. False: the ring is empty.
  bool pop(T& value) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return false;
    value = slots_[tail & (slots_.size() - 1)];
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

 private:
  std::vector<T> slots_;
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
};

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
