#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "image/image.h"
#include "xray/geometry/c_arm.h"

namespace trocar::xray {

/// A lower signal is replaced by this one before its logarithm is taken.
inline constexpr float kLeastSignal = 1e-6F;

/// Values that are shown between black and white.
struct GrayWindow {
  float low = 0.0F, high = 1.0F;
};

struct DisplaySettings {
  bool is_logarithmic = true;  ///< Shown is the attenuation -ln(signal); otherwise the signal.
  bool is_inverted = false;    ///< Dense things are white, as in a radiograph; otherwise dark, as in fluoroscopy.
  /// Share of great differences (lung against abdomen) that is taken off, so that both fit the window and small ones
  /// (ribs, ducts) keep their contrast. Range 0..0.9.
  double range_compression = 0.65;
  double edge_gain = 0.6;            ///< Of unsharp masking. Range 0..4; 0: off.
  double edge_sigma_px = 2.0;        ///< Standard deviation of its Gaussian. Range 0.7..20.
  std::optional<GrayWindow> window;  ///< In shown values; empty: from the image.

  bool operator==(const DisplaySettings& other) const noexcept;
};

/// Pixels in the collimated field: [first, last) of columns and rows.
struct FieldPixels {
  int first_column = 0, last_column = 0, first_row = 0, last_row = 0;
};
FieldPixels field_pixels(const CArm& arm) noexcept;

/// Shown values: attenuation or the negative of the signal, so that greater is denser, with compressed range and
/// enhanced edges. Outside of the field: the values at its edge.
std::vector<float> shown_values(std::span<const float> signal, int columns, int rows, const DisplaySettings& settings,
                                const FieldPixels& field);

/// Window of the values in the field: from the 1st to the 99th percentile, at least `least_width` wide. The bright side
/// of the median is at most twice as wide as its dark side, so that lungs at the edge do not darken the abdomen.
/// Direct radiation (`signal` > 0.5) is left out if the rest covers a twentieth of the field. docs/physics.md, X12.
GrayWindow window_of(std::span<const float> values, std::span<const float> signal, int columns,
                     const FieldPixels& field, float least_width = 0.1F);

/// Eight bits, even over the window and flatter towards and beyond its ends; outside of the field (shutters) black.
image::GrayImage to_gray(std::span<const float> values, int columns, int rows, const GrayWindow& window,
                         bool is_inverted, const FieldPixels& field);

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
  void overlay(float least, float full, image::GrayImage& image) const;

 private:
  std::vector<float> greatest_;
};

}  // namespace trocar::xray
