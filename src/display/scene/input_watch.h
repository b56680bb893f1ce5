#pragma once

#include <memory>

namespace trocar::scene {

/// Sees the user's hand while a program is busy drawing and reads no events: asks the X server itself whether pointer,
/// buttons or keys have changed. Without an X server nothing ever happens.
class InputWatch {
 public:
  InputWatch();
  ~InputWatch();
  InputWatch(const InputWatch&) = delete;
  InputWatch& operator=(const InputWatch&) = delete;

  /// From now on.
  void start();
  /// Pointer, a button or a key are not as they were at `start`. About 0.1 ms.
  bool has_happened();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::scene
