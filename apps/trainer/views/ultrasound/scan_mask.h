#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "geometry/pose.h"
#include "ultrasound/probe/scan_geometry.h"

namespace trocar::trainer {

/// Mask of an ultrasound image in 3D, one byte per pixel: 255 within the scan (sampled scanlines and depths), 0
/// outside. Caches its last results by size, scan and image pose relative to the transducer, because a live scanner
/// alternates between a few numbers of scanlines.
class ScanMask {
 public:
  const std::vector<std::uint8_t>& of(int columns, int rows, const std::array<Vec3, 3>& corners_P, const Pose& X_PT,
                                      const ultrasound::ScanGeometry& scan);

 private:
  struct Key {
    int columns = 0;
    int rows = 0;
    ultrasound::Vec2 corner_T{0, 0};
    ultrasound::Vec2 right_T{0, 0};
    ultrasound::Vec2 down_T{0, 0};
    std::array<double, 5> scan{};
  };
  struct Answer {
    Key key;
    std::vector<std::uint8_t> alpha;
  };
  static constexpr std::size_t kMostAnswers = 6;
  static bool are_near(const Key& a, const Key& b);
  static std::vector<std::uint8_t> painted(const Key& key, const ultrasound::ScanGeometry& scan);
  std::deque<Answer> answers_;  ///< Newest first.
};

}  // namespace trocar::trainer
