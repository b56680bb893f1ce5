#pragma once

#include <array>
#include <cstdint>

#include "haptics/haptic_scene.h"

namespace trocar::haptics {

/// The straight channel of a needle: its line, the resting tissue along it, pierced layers and cut depth. Fixed size;
/// copied, never allocated. Coordinate s (mm): along the line, 0 on the resting skin.
struct Channel {
  static constexpr double kBin_mm = 0.1;
  static constexpr int kBins = 3000;  ///< 300 mm, the longest needle.

  bool is_used = false;
  Vec3 origin_P = Vec3::Zero();      ///< P: where the line meets the resting skin.
  Vec3 direction_P = Vec3::UnitZ();  ///< u, unit.
  std::uint32_t pierced = 0;         ///< One bit per pierced layer.
  double cut_to_mm = 0.0;            ///< Deepest s that the tip has reached.
  int known_bins = 0;                ///< Bins [0, known_bins) are filled.
  std::array<std::uint8_t, kBins> tissue{};
  std::array<std::uint8_t, kBins> label{};
  std::array<std::int16_t, kBins> hu{};  ///< CT value; filled if the force model reads it, else 0.

  /// Wall that begins at this bin (volume proxy; physics.md B4): layer to pierce, else kNoLayer.
  std::array<std::uint8_t, kBins> wall{};
  std::uint8_t wall_here = kNoLayer;    ///< Walled structure of the last known bin.
  std::uint8_t wall_before = kNoLayer;  ///< Walled structure of the section before it.
  int wall_since = 0;                   ///< First bin of the section of wall_here.

  void forget_bins() noexcept {
    known_bins = wall_since = 0;
    wall_here = wall_before = kNoLayer;
  }
  bool is_pierced(std::uint8_t layer) const noexcept { return ((pierced >> layer) & 1U) != 0; }
  void pierce(std::uint8_t layer) noexcept { pierced |= 1U << layer; }
};

/// Bin of a depth, clamped to the channel.
int bin_of(double s_mm) noexcept;

/// How far a force model looks beyond the tip and the device: more than the motion of one tick.
inline constexpr double kLook_mm = 10.0;
/// Fills the bins up to `ahead_mm` past s along the line, at most kMaxBinsPerLook new bins per call. Real-time safe.
inline constexpr int kMaxBinsPerLook = 200;
/// A structure that the line leaves for less than this is not left: corners of voxels. [assumed: a voxel's diagonal]
inline constexpr double kSameStructure_mm = 2.0;
void look_ahead(Channel& channel, const HapticScene& scene, double s_mm, double ahead_mm) noexcept;

/// The first unpierced layer that begins between `from_mm` and `to_mm` within the known bins. In the combined model a
/// layer that is no wall (muscle) is a border of the CT, labelled or not, and no layer (physics.md T2).
struct LayerAhead {
  std::uint8_t layer = kNoLayer;
  double surface_mm = 0.0;  ///< s of its resting surface.
};
LayerAhead next_layer(const Channel& channel, const HapticScene& scene, double from_mm, double to_mm) noexcept;

/// The first wall that begins in uncut tissue between `from_mm` and `to_mm` within the known bins. Punctured walls stay
/// open.
LayerAhead next_wall(const Channel& channel, double from_mm, double to_mm) noexcept;

/// Channels of the past insertions of one attempt. A new channel replaces the oldest one when the memory is full.
struct ChannelMemory {
  static constexpr int kCapacity = 8;
  static constexpr double kSameHole_mm = 1.0;  ///< Entries within this distance and kSameHole_rad use the same hole.
  /// Largest angle between two entries into the same hole, 5 degrees. [assumed]
  static constexpr double kSameHole_rad = 0.0873;
  std::array<Channel, kCapacity> channels{};
  int next = 0;

  /// The earlier channel that a needle at this position enters, or nullptr.
  const Channel* find(const Vec3& entry_P, const Vec3& axis_P) const noexcept;
  /// Stores a channel; replaces one with the same line.
  void remember(const Channel& channel) noexcept;
};

}  // namespace trocar::haptics
