#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "geometry/pose.h"
#include "ultrasound/engine/detail/scan_plan.h"
#include "ultrasound/engine/detail/scatterer_gain.h"
#include "ultrasound/engine/detail/tiled_tissue.h"
#include "ultrasound/engine/needle_echo.h"
#include "ultrasound/probe/probe_contact.h"

namespace trocar::ultrasound::detail {

/// A scanline as voxel indices of the scene: origin + along * mm + lateral * mm + elevation * mm, reflected where it
/// lies behind a mirror.
struct LineWalk {
  std::array<float, 3> origin{}, along{}, lateral{};  ///< Index, index a mm.
  /// Distance behind the mirror, mm: [0] + [1] * along + [2] * elevation + [3] * lateral.
  std::array<float, 4> mirror{};
  std::array<float, 3> mirror_normal{};  ///< Index for each mm of distance, twice.
  float mirror_gain = 0.0F;              ///< Amplitude of what the mirror shows.
  /// Along the central plane, from the face; infinite: no mirror.
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
  float log_gain = 0.0F;                ///< Neper, of the way there and back.
  std::array<float, 3> index{};         ///< Place, fractional voxels.
  std::uint8_t before = 0, behind = 0;  ///< Tissues.
};
inline constexpr int kMaxBorders = 32;  ///< A scanline and plane.

/// What a search among a scanline's borders looks at.
struct BorderKey {
  float walk = 0.0F;  ///< Sample.
  std::uint16_t tissues = 0;
};
constexpr std::uint16_t tissues_of(const Border& border) noexcept {
  return static_cast<std::uint16_t>(border.before << 8 | border.behind);
}

/// The first gas that a scanline meets, on the central plane.
struct GasBorder {
  bool is_there = false;
  Border border;
  float slope_across = 0.0F;  ///< Of its surface, across the image, from the volume's gradient.
};

/// The strongest smooth reflector of a scanline, for what goes to and fro before it.
struct Reflector {
  float shown = -1.0F;     ///< Sample; negative: none.
  float amplitude = 0.0F;  ///< Of the sound that comes back, 0..1, losses on the way in it.
  float rough_amplitude = 0.0F;
  bool is_gas = false;
  std::uint32_t key = 0;  ///< Of its place in P.
};

/// Tissue that a needle drags along.
struct Drag {
  Vec3f tip_T = Vec3f::Zero();
  Vec3f shift_T = Vec3f::Zero();
  float reach_mm = 0.0F;  ///< 0: none.
};

/// One frame in the making. All that grows is sized by make_frame_state.
struct FrameState {
  const AcousticScene* scene = nullptr;
  TiledTissue tiles;
  Pose X_PT;
  std::array<std::array<float, 3>, 3> index_of_T{};  ///< Columns: voxel index a mm of x, y, z of T.
  std::array<float, 3> index_of_origin{};
  std::array<float, 3> elevation{};  ///< Index a mm.
  Drag drag;
  float widest_warp = 0.0F;  ///< Scanlines.
  float deepest_dent_mm = 0.0F;
  float dent_reach = 1.0F;  ///< Samples: deeper tissue does not yield.

  std::vector<LineContact> contact;
  std::vector<float> contact_shape;  ///< A sample of `walk`: share of the dent that tissue there follows.
  std::vector<LineWalk> walks;
  std::vector<int> audible;                 ///< A scanline: samples, on any plane, before nothing more comes back.
  std::vector<Border> borders;              ///< (plane * lines + line) * kMaxBorders.
  std::vector<BorderKey> border_keys;       ///< The same.
  std::vector<std::uint8_t> border_counts;  ///< plane * lines + line.
  std::vector<float> pressed_samples;       ///< A scanline: how deep the face dents the skin.
  std::vector<GasBorder> gas;
  std::vector<Reflector> reflectors;
  std::vector<float> bend_mm;          ///< line * coarse_samples: sideways displacement by refraction.
  std::vector<float> probed_way;       ///< The same: neper left of an echo, without its own strength.
  std::vector<float> focus_log;        ///< The same: neper of amplitude by beams that part or meet.
  std::vector<float> smooth_slowness;  ///< The same, over the beam's width.
  std::vector<float> slowness;         ///< The same: c0/c - 1 of the central plane.
  std::vector<float> delay;            ///< line * samples: shown - walk, samples.
  std::vector<float> way_gain;         ///< The same: amplitude left of an echo from there, without its own strength.
  std::vector<ScattererGain> gain;     ///< (plane * lines + line) * samples: of a scatterer there; two more.
  std::vector<float> re, im;           ///< ScanPlan::echo_row(line) + sample: echoes before the point spread.
};

FrameState make_frame_state(const AcousticScene& scene);
/// Takes buffers for a plan.
void fit_frame(FrameState& frame, const ScanPlan& plan);
/// Before a frame: no border is known on any plane, so that nothing of the last frame can be read.
void clear_borders(FrameState& frame) noexcept;

}  // namespace trocar::ultrasound::detail
