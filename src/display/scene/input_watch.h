#pragma once

#include <memory>

namespace trocar::scene {

/// Detects user input while the program draws and processes no events: queries pointer, buttons and keys from the X
/// server. Without an X server it never reports input.
class InputWatch {
 public:
  InputWatch();
  ~InputWatch();
  InputWatch(const InputWatch&) = delete;
  InputWatch& operator=(const InputWatch&) = delete;

  /// Starts the detection.
  void start();
  /// True if the pointer, a button or a key has changed since `start`. Takes about 0.1 ms.
  bool has_happened();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::scene

namespace trocar::scene::detail {

/// True if $DISPLAY names an X server with OpenGL (GLX). Opens and closes a connection.
bool has_opengl_display() noexcept;

}  // namespace trocar::scene::detail
