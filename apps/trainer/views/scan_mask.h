#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/pose.h"
#include "ultrasound/scan_geometry.h"

namespace trocar::trainer {

/// One byte a pixel of an ultrasound picture in space: 255 within the scan (scanlines and depths that are sampled), 0
/// outside. Keeps its answer until size, scan or the picture's place against the transducer change.
class ScanMask {
 public:
  const std::vector<std::uint8_t>& of(int columns, int rows, const std::array<Vec3, 3>& corners_P, const Pose& X_PT,
                                      const ScanGeometry& scan);

 private:
  struct Key {
    int columns = 0;
    int rows = 0;
    Vec2 corner_T{0, 0};
    Vec2 right_T{0, 0};
    Vec2 down_T{0, 0};
    std::array<double, 6> scan{};
  };
  Key key_;
  std::vector<std::uint8_t> alpha_;
};

}  // namespace trocar::trainer
