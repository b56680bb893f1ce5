#pragma once

#include <memory>
#include <span>
#include <vector>

namespace trocar::devices {

/// Plays short sounds on the system's default output. Where there is none it is silent. Nothing waits: the output is
/// opened on a thread of its own, and what is played before it is open is not heard.
class Speaker {
 public:
  Speaker();
  ~Speaker();
  Speaker(const Speaker&) = delete;
  Speaker& operator=(const Speaker&) = delete;

  /// Mono, -1..1, at kRate_hz; replaces what is being played.
  void play(std::span<const float> samples);
  bool is_open() const noexcept;

  static constexpr int kRate_hz = 44'100;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The click of a biopsy gun, made by computation: the stylet's spring, and the cannula's 60 ms later.
std::vector<float> make_gun_click();

}  // namespace trocar::devices
