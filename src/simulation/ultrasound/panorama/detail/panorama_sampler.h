#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ultrasound/panorama/panorama.h"

/// Samples of a panorama along a scanline (docs/physics.md U17).
namespace trocar::ultrasound::detail {

inline constexpr std::size_t kReadBeyond = 16;  ///< Bytes behind the voxels that kernels read.
/// Weights are sampled in steps of at most this length, and interpolated between them.
inline constexpr double kWeightStep_mm = 1.2;
inline constexpr int kWeightSteps = 8;  ///< At most this number of samples per step.
inline constexpr int kMostLinePlanes = 9;
inline constexpr int kReadAhead = 32;  ///< Values behind a scanline's samples that kernels read and write.

/// Planes across the beam's thickness and their share of an echo's power; the shares' sum is 1.
struct BeamPlanes {
  int count = 1;
  std::array<float, kMostLinePlanes> zeta{};  ///< Distance from the image plane, in sigmas of the beam.
  std::array<float, kMostLinePlanes> share{};
};
/// `count`: 1, 3, 5, 7 or 9.
BeamPlanes make_beam_planes(int count) noexcept;

/// Affine map from T to voxel indices of a panorama.
struct PanoramaMap {
  const Panorama* panorama = nullptr;
  std::array<std::array<float, 3>, 3> index_of_T{};  ///< Columns: index per mm along x, y, z of T.
  std::array<float, 3> index_of_origin{};
};
PanoramaMap make_panorama_map(const Panorama& panorama, const Pose& X_PT) noexcept;

/// A scanline in the panorama. Arrays have `samples` values and kReadAhead more.
struct PanoramaLine {
  std::array<float, 2> origin_T{}, along_T{};  ///< x, y: origin on the face, unit direction.
  const float* rest_mm = nullptr;              ///< Distance from the origin in the resting tissue.
  const float* sigma_mm = nullptr;             ///< Of the beam's thickness.
  int samples = 0;
  int near_samples = 0;  ///< In front of kNearGap_mm.
  int weight_step = 1;   ///< Samples per step of the weights: 1..kWeightSteps.
};

/// The panorama is whole from this depth on, or it is not continued to the face. Assumed: dents differ by some
/// millimetres. Range 10..30.
inline constexpr double kNearGap_mm = 20.0;

/// Samples per step of the weights.
int weight_step(double sample_mm) noexcept;
/// Of how many samples of a scanline one is taken from the panorama, 1 or 2: its voxels are longer.
int sample_stride(const Panorama& panorama, double sample_mm) noexcept;
/// Fills `samples` values between those of every stride-th one.
void expand_samples(const std::vector<float>& from, int stride, int samples, float* to) noexcept;

/// Power and weight of a scanline's samples.
struct PanoramaSamples {
  std::vector<float> power;   ///< Mean of 10^((level - tissue_db)/10) over the thickness; 0 where `weight` is 0.
  std::vector<float> weight;  ///< 0..1: share of the panorama.
  float least_weight = 1.0F, most_weight = 0.0F;

  void fit(int samples);
};

/// Fills `samples`. Allocates nothing. Where the panorama begins near the face, its first samples continue to the face,
/// mirrored: the volume ends at the face of the transducer that acquired it, which has another shape.
void sample_panorama(const PanoramaMap& map, const BeamPlanes& planes, const PanoramaLine& line,
                     PanoramaSamples& samples) noexcept;

}  // namespace trocar::ultrasound::detail
