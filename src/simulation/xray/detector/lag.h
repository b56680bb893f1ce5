#pragma once

#include <span>
#include <vector>

namespace trocar::xray {

/// First-order lag of the detector: a share of the former signal is left in the next image. docs/physics.md, X10.
class Lag {
 public:
  /// Mixes the former images into a signal that is read `elapsed_s` after the former one, and keeps it. `share`:
  /// DetectorParams::lag_share, left after 1/30 s. The first image, and the first of another size, are unchanged.
  void apply(double share, double elapsed_s, std::span<float> signal);
  void reset() noexcept { former_.clear(); }

 private:
  std::vector<float> former_;
};

}  // namespace trocar::xray
