#pragma once

#include <span>
#include <vector>

#include "xray/fluoroscopy/display.h"

namespace trocar::xray {

/// Digital subtraction: the mean of mask frames, from which the logarithm of the live signal is subtracted.
class MaskSubtraction {
 public:
  void clear() noexcept;
  /// Adds a frame to the mask. A frame of another size begins a new mask.
  void add_mask(std::span<const float> signal);
  int mask_frames() const noexcept { return frames_; }
  /// ln(mask) - ln(signal) of each pixel: the attenuation that was added since the mask; 0 without a mask of this size.
  std::vector<float> difference(std::span<const float> signal) const;

 private:
  std::vector<float> sum_;
  int frames_ = 0;
};

/// Road map: the greatest opacification of each pixel while contrast agent flows, shown over live fluoroscopy.
class RoadMap {
 public:
  void clear() noexcept { greatest_.clear(); }
  bool is_empty() const noexcept { return greatest_.empty(); }
  /// Adds differences of MaskSubtraction. Those of another size begin a new map.
  void add(std::span<const float> difference);
  std::span<const float> greatest() const noexcept { return greatest_; }
  /// Blends the map into an image of the same size: opacified pixels become light, in proportion. `full`: opacification
  /// that is shown fully. Below `least` (noise) nothing is shown.
  void overlay(float least, float full, GrayImage& image) const;

 private:
  std::vector<float> greatest_;
};

}  // namespace trocar::xray
