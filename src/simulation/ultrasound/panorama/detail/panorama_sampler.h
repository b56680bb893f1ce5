#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "motion/patient_motion.h"
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
  int weight_step = 1;  ///< Samples per step of the weights: 1..kWeightSteps.
};

/// A panorama that is whole from the first depth on is continued to the face, one from the second on is not, with a
/// smooth transition. Assumed: dents of different faces differ by some millimetres. Range 8..40.
inline constexpr double kNearGap_mm = 17.0, kFarGap_mm = 24.0;

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
  /// Where the patient moves: from a sample's place now to its tissue at rest, in voxels along each axis.
  std::array<std::vector<float>, 3> to_rest;

  void fit(int samples);
};

/// Fills `samples`. Allocates nothing. The map is that of the transducer in the patient now, `motion` its motion.
void sample_panorama(const PanoramaMap& map, const motion::PatientMotion& motion, const BeamPlanes& planes,
                     const PanoramaLine& line, PanoramaSamples& samples) noexcept;

/// Where a panorama begins near the face: it ends at the face of the transducer that acquired it, which has another
/// shape.
struct NearEnd {
  int whole = 0;       ///< First sample that is whole.
  int known = 0;       ///< First sample in front of it that can be continued to the face, mirrored.
  float share = 1.0F;  ///< How much it is continued: by kNearGap_mm and kFarGap_mm.
};
NearEnd find_near_end(const float* weight, int near_samples, int far_samples) noexcept;
/// Shares that change over 2 * reach scanlines and are at most those of the ends. All of one size.
inline constexpr double kShareReach_mm = 5.0;  ///< Assumed, range 2..10.
void smooth_shares(const std::vector<NearEnd>& ends, int reach, std::vector<float>& working,
                   std::vector<float>& shares) noexcept;
/// Raises the weights in front of an end, and mirrors the power there.
void continue_to_face(const NearEnd& end, float share, int samples, float* power, float* weight) noexcept;

}  // namespace trocar::ultrasound::detail
