#pragma once

#include <array>
#include <cstdint>

#include "haptics/haptic_scene.h"

namespace trocar::haptics {

/// The tissue that a channel runs through where the patient moves: material points at rest, one every kNode_mm of s
/// from the skin to the deepest cut.
struct ChannelNodes {
  static constexpr double kNode_mm = 2.0;
  static constexpr int kMost = 151;  ///< 300 mm, the longest needle.

  int count = 0;  ///< 0: the patient has no motion, the channel is its line.
  std::array<Vec3, kMost> p_A = zero_vectors<kMost>();
  Vec3 onward_A = Vec3::UnitZ();  ///< Change per mm of s at the first node, as it was cut.
  /// Where the known bins ended when they were filled, and half way there from the cut: if tissue there moves against
  /// the needle's line, they are filled again.
  std::array<double, 2> seen_mm{};
  std::array<Vec3, 2> seen_A = zero_vectors<2>();

  double end_mm() const noexcept { return kNode_mm * (count - 1); }
};

/// The channel of a needle: its course, the tissue along it, pierced layers and cut depth. Straight in a patient at
/// rest; where the patient moves, it moves and bends with its tissue. Fixed size; copied, never allocated. Coordinate s
/// (mm): along the channel as it was cut, 0 on the skin; it stays with the tissue.
struct Channel {
  static constexpr double kBin_mm = 0.1;
  static constexpr int kBins = 3000;  ///< 300 mm, the longest needle.

  bool is_used = false;
  /// The channel's line now: the whole of it at rest; where the patient moves, that of the needle in it (carry).
  Vec3 origin_P = Vec3::Zero();      ///< s = 0 on that line; at rest where it meets the skin.
  Vec3 direction_P = Vec3::UnitZ();  ///< u, unit.
  ChannelNodes nodes;
  std::uint32_t pierced = 0;  ///< One bit per pierced layer.
  double cut_to_mm = 0.0;     ///< Deepest s that the tip has reached.
  int known_bins = 0;         ///< Bins [0, known_bins) are filled.
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
  /// Forgets the bins from one on, which must be known.
  void forget_bins_from(int bin, const HapticScene& scene) noexcept;
  bool is_pierced(std::uint8_t layer) const noexcept { return ((pierced >> layer) & 1U) != 0; }
  void pierce(std::uint8_t layer) noexcept { pierced |= 1U << layer; }
};

/// Line on which tissue holds a needle that hardly bends: s = 0 and unit direction into the body.
struct ChannelLine {
  Vec3 origin_P = Vec3::Zero();
  Vec3 direction_P = Vec3::UnitZ();

  Vec3 at(double s_mm) const noexcept { return origin_P + s_mm * direction_P; }
};
/// Where the patient moves: the line through the channel's tissue around the needle's tip, `ahead_s` later with the
/// tissue's velocity (physics.md S2). It changes smoothly, also where the tip passes from tissue to other tissue that
/// slides along it. The channel has nodes. Real-time safe.
ChannelLine needle_line(const Channel& channel, const motion::PatientMotion& motion, double tip_mm,
                        double ahead_s = 0.0) noexcept;

/// The course of a channel at one moment, behind the last node along its line. Real-time safe.
class ChannelNow {
 public:
  ChannelNow(const Channel& channel, const motion::PatientMotion& motion) noexcept
      : channel_(channel), motion_(motion) {}

  Vec3 point_P(double s_mm) const noexcept;    ///< Point of the channel.
  Vec3 tangent_P(double s_mm) const noexcept;  ///< Unit, into the body.
  Vec3 rest_A(double s_mm) const noexcept;     ///< The tissue at that point, at rest.

 private:
  Vec3 node_P(int node) const noexcept { return motion_.to_now(channel_.nodes.p_A[static_cast<std::size_t>(node)]); }
  Vec3 node_tangent_P(int node) const noexcept;

  const Channel& channel_;
  const motion::PatientMotion& motion_;
};

/// Where the patient moves: gives a channel that has just opened its first node. Real-time safe.
void begin_nodes(Channel& channel, const motion::PatientMotion& motion) noexcept;
/// Where the patient moves: sets the channel's line to the needle's with its tip at `tip_mm`, and forgets what it knows
/// of tissue in front of the cut that has moved against it. Real-time safe.
void carry(Channel& channel, const PatientNow& now, double tip_mm) noexcept;
/// Where the patient moves: adds nodes up to the deepest cut. Real-time safe.
void extend_nodes(Channel& channel, const motion::PatientMotion& motion) noexcept;

/// Bin of a depth, clamped to the channel.
int bin_of(double s_mm) noexcept;

/// How far a force model looks beyond the tip and the device: more than the motion of one tick.
inline constexpr double kLook_mm = 10.0;
/// Fills the bins up to `ahead_mm` past s along the channel, at most kMaxBinsPerLook new bins per call. Real-time safe.
inline constexpr int kMaxBinsPerLook = 200;
/// A structure that the line leaves for less than this is not left: corners of voxels. [assumed: a voxel's diagonal]
inline constexpr double kSameStructure_mm = 2.0;
void look_ahead(Channel& channel, const PatientNow& now, double s_mm, double ahead_mm) noexcept;

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
  const Channel* find(const Vec3& entry_P, const Vec3& axis_P,
                      const motion::PatientMotion& motion = kAtRest) const noexcept;
  /// Stores a channel; replaces one that is the same.
  void remember(const Channel& channel) noexcept;
};

}  // namespace trocar::haptics
