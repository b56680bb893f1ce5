#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "core/parallel.h"
#include "geometry/pose.h"
#include "motion/patient_motion.h"
#include "ultrasound/engine/detail/scan_plan.h"
#include "ultrasound/engine/detail/scatterer_gain.h"
#include "ultrasound/engine/detail/tiled_tissue.h"
#include "ultrasound/engine/echo_engine.h"
#include "ultrasound/probe/probe_contact.h"

namespace trocar::ultrasound::detail {

/// A scanline as voxel indices of the scene: origin + along * mm + lateral * mm + elevation * mm, reflected behind a
/// mirror.
struct LineWalk {
  std::array<float, 3> origin{}, along{}, lateral{};  ///< Index, index per mm.
  /// Distance behind the mirror, mm: [0] + [1] * along + [2] * elevation + [3] * lateral.
  std::array<float, 4> mirror{};
  std::array<float, 3> mirror_normal{};  ///< Twice the index per mm of distance.
  float mirror_gain = 0.0F;              ///< Amplitude of the mirror image.
  /// Depth along the central plane from the face; infinite: no mirror.
  float mirror_depth_mm = std::numeric_limits<float>::infinity();
  float mirror_reflection = 0.0F;
  std::uint8_t mirror_before = 0, mirror_behind = 0;  ///< Tissues.
  float pressed_mm = 0.0F;
  float coupling = 1.0F;

  bool has_mirror() const noexcept { return mirror_depth_mm < std::numeric_limits<float>::infinity(); }
};

/// A border that a scanline crosses.
struct Border {
  float walk = 0.0F;                    ///< Sample.
  float reflection = 0.0F;              ///< Amplitude under normal incidence, -1..1.
  float log_gain = 0.0F;                ///< Neper, two-way.
  std::array<float, 3> index{};         ///< Position, fractional voxels.
  std::uint8_t before = 0, behind = 0;  ///< Tissues.
};
inline constexpr int kMaxBorders = 32;  ///< Per scanline and plane.

/// Key for a search among a scanline's borders.
struct BorderKey {
  float walk = 0.0F;  ///< Sample.
  std::uint16_t tissues = 0;
};
constexpr std::uint16_t tissues_of(const Border& border) noexcept {
  return static_cast<std::uint16_t>(border.before << 8 | border.behind);
}

/// First gas on a scanline, on the central plane.
struct GasBorder {
  bool is_there = false;
  Border border;
  float slope_across = 0.0F;  ///< Slope of its surface across the image, from the volume's gradient.
};

/// The strongest smooth reflector of a scanline, for the multiple echoes in front of it.
struct Reflector {
  float shown = -1.0F;     ///< Sample; negative: none.
  float amplitude = 0.0F;  ///< Amplitude of the returned sound, 0..1, including the losses on the path.
  float rough_amplitude = 0.0F;
  bool is_gas = false;
  float bubbles = 0.0F;  ///< Of gas: whether its bubbles ring, -1..1; the same over some millimetres.
};

/// Phase of a position in the layers of muscle and fat, and their strength there.
struct Layering {
  float phase = 0.0F;
  float strength = -1.0F;  ///< Negative: not computed, for tissue without layers.
};

/// Displacement of tissue by a needle.
struct Drag {
  Vec3f tip_T = Vec3f::Zero();
  Vec3f shift_T = Vec3f::Zero();
  float reach_mm = 0.0F;  ///< 0: none.
};

/// Points of a scene and a ball around them.
struct PointGroup {
  std::size_t first = 0, last = 0;  ///< Of AcousticScene::points, without `last`.
  Vec3 centre_P = Vec3::Zero();
  double radius_mm = 0.0;
};

/// State of one frame during its computation. fit_frame sizes the buffers.
struct FrameState {
  const AcousticScene* scene = nullptr;
  TiledTissue tiles;
  std::vector<PointGroup> point_groups;
  Pose X_PT;
  motion::PatientMotion motion;
  std::array<std::array<float, 3>, 3> index_of_T{};  ///< Columns: voxel index per mm of x, y, z of T.
  std::array<float, 3> index_of_origin{};
  std::array<float, 3> elevation{};  ///< Index per mm.
  Drag drag;
  float widest_warp = 0.0F;  ///< Scanlines.
  float deepest_dent_mm = 0.0F;
  float dent_reach = 1.0F;  ///< Samples: deeper tissue does not yield.

  std::vector<LineContact> contact;
  std::vector<float> contact_shape;  ///< Per sample of `walk`: share of the dent that tissue there follows.
  std::vector<LineWalk> walks;
  std::vector<int> audible;     ///< Per scanline: samples in front of the depth from which no plane receives an echo.
  std::vector<Border> borders;  ///< ScanPlan::row_of(plane, line) * kMaxBorders.
  std::vector<BorderKey> border_keys;       ///< Indexed like `borders`.
  std::vector<std::uint8_t> border_counts;  ///< Per walked row.
  std::vector<float> pressed_samples;       ///< Per scanline: depth of the dent that the face makes in the skin.
  std::vector<GasBorder> gas;
  std::vector<Reflector> reflectors;
  std::vector<float> bend_mm;  ///< line * coarse_samples: sideways displacement by refraction.
  /// line * coarse_samples: amplitude of an echo after losses along the straight scanline, neper, without its own
  /// strength.
  std::vector<float> probed_way;
  std::vector<float> open_way;  ///< The same for sound from the whole aperture.
  std::vector<int> reach;       ///< Per scanline: samples in front of the depth from which open_way is inaudible.
  std::vector<float> absorbed;  ///< line * coarse_samples: the part of probed_way that grows with frequency, neper.
  /// line * coarse_samples: change of amplitude by diverging or converging beams, edges and spectrum, neper.
  std::vector<float> path_log;
  std::vector<float> edge_loss;        ///< line * coarse_samples: at the edges of surfaces, neper.
  std::vector<float> smooth_slowness;  ///< line * coarse_samples: slowness, averaged over the beam's width.
  std::vector<Layering> layers;        ///< line * layer_steps, behind each kLayering samples of the straight scanline.
  std::vector<float> slowness;         ///< line * coarse_samples: c0/c - 1 on the central plane.
  std::vector<float> delay;            ///< line * samples: shown - walk, samples.
  /// line * samples: amplitude of an echo from there after losses, without its own strength.
  std::vector<float> way_gain;
  /// ScanPlan::row_of(plane, line) * samples: gain of a scatterer there; two more values at the end.
  std::vector<ScattererGain> gain;
  std::vector<float> re, im;      ///< ScanPlan::echo_row(line) + sample: echoes before the point spread.
  std::vector<float> power;       ///< block * lines + line: mean power of the echoes in kLobeBlock samples.
  std::vector<float> power_sums;  ///< block * (lines + 1) + line: sum of `power` before that scanline.
  /// block * (lines + 2 * lateral_reach) + lateral_reach + line: largest |re| or |im| in kLobeBlock samples; 0 beyond
  /// the scanlines.
  std::vector<float> loudest;
};

FrameState make_frame_state(const AcousticScene& scene);
/// Sizes the buffers for a plan.
void fit_frame(FrameState& frame, const ScanPlan& plan);
/// Clears the border counts of scanlines [first, last) on all planes. Call before a frame, so that no border of the
/// last frame is read.
void clear_borders(const ScanPlan& plan, FrameState& frame, int first, int last) noexcept;
/// Clears the scanlines that are not in `lines`, so that a frame of these depends on no earlier frame; the paths of
/// those in `probed`, a range around `lines`, are computed again.
void silence_outside(const ScanPlan& plan, FrameState& frame, const LineRange& lines, const LineRange& probed) noexcept;

}  // namespace trocar::ultrasound::detail

/// Ranges of scanlines, and their distribution to threads.
namespace trocar::ultrasound::detail {

inline int group_count(int lines) noexcept {
  return (lines + kGroup - 1) / kGroup;
}

/// Calls body(number of the group, first, last) for groups of at most kGroup scanlines of a range on several threads.
template <class Body>
void for_groups(const LineRange& lines, const Body& body) noexcept {
  const auto part = [&](std::size_t first, std::size_t last) {
    for (std::size_t g = first; g < last; ++g) {
      const int begin = lines.first + static_cast<int>(g) * kGroup;
      body(static_cast<int>(g), begin, std::min(begin + kGroup, lines.last));
    }
  };
  parallel_for(static_cast<std::size_t>(group_count(lines.count())), 1, std::ref(part));
}

/// The range and `margin` scanlines on either side, widened to multiples of four; an empty range: all of `lines`.
inline LineRange widened(const LineRange& range, int margin, int lines) noexcept {
  if (range.is_empty()) return {0, lines};
  const int first = std::clamp(range.first - margin, 0, lines - 1) / kMostStride * kMostStride;
  const int last = std::clamp(range.last + margin, first + 1, lines);
  return {first, std::min(first + (last - first + kMostStride - 1) / kMostStride * kMostStride, lines)};
}

}  // namespace trocar::ultrasound::detail
