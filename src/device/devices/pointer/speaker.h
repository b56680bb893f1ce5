#pragma once

#include <memory>
#include <span>
#include <vector>

namespace trocar::devices {

/// Plays short sounds on the system's default output; without an output it plays nothing. A separate thread opens the
/// output, so that play() does not wait. Sounds that are played before it is open are dropped.
class Speaker {
 public:
  Speaker();
  ~Speaker();
  Speaker(const Speaker&) = delete;
  Speaker& operator=(const Speaker&) = delete;

  /// Plays mono samples, -1..1, at kRate_hz. They replace the sound that is being played.
  void play(std::span<const float> samples);
  bool is_open() const noexcept;
  /// True until an output was opened, or none was found.
  bool is_opening() const noexcept;

  static constexpr int kRate_hz = 44'100;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Synthesises the click of a biopsy gun: the spring of the stylet, and that of the cannula 60 ms later.
std::vector<float> make_gun_click();

}  // namespace trocar::devices
