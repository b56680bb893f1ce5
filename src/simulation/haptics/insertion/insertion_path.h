#pragma once

#include <array>
#include <cstdint>

#include "haptics/haptic_scene.h"
#include "haptics/insertion/channel.h"

namespace trocar::haptics {

/// Labels that the tip entered in a step, 0 = none.
struct EnteredLabels {
  std::array<std::uint8_t, 3> labels{};
  bool is_overflown = false;
};

/// Path of the needle into the body, for all force models: its line after the skin puncture, the tip's progress on it,
/// and the channels of earlier insertions. Fixed size.
struct InsertionPath {
  bool is_open = false;  ///< The skin is pierced and the needle stays on the channel's line.
  Channel channel;       ///< Channel of this insertion.
  ChannelMemory memory;  ///< Holes of past insertions.
  double rest_mm = 0.0;  ///< Tip along the channel in undented tissue; at the layer's surface while a layer is loaded.
  double travel_mm = 0.0;  ///< Distance travelled by the tip through the resting tissue, in and out.
  std::uint8_t label = 0;  ///< Label at the tip.
  std::array<double, kMaxTissues> inserted_mm{};  ///< Shaft length in each tissue.
  Vec3 contact_to_puncture_P = Vec3::Zero();      ///< PX_p of paper A; zero before the skin puncture.
  /// Force (N) along the path with which the bed of the bent shaft pushes the needle out, of the last step (B7).
  double bed_out_n = 0.0;
  double bed_out_n_per_mm = 0.0;  ///< Its growth with depth, >= 0.
};

/// Starts a new channel on a line. Real-time safe.
void start_channel(InsertionPath& path, const Vec3& origin_P, const Vec3& direction_P) noexcept;

/// Opens the path at the skin, on the channel's line. Real-time safe.
void open_path(InsertionPath& path, std::uint8_t skin_layer, const motion::PatientMotion& motion = kAtRest) noexcept;

/// Moves the tip through undented tissue: updates shaft lengths, labels entered and cut depth. A label is entered when
/// the tip is beyond its border and the layer over it is not `loading`, the layer that the tip indents (kNoLayer:
/// none). A liver, for example, is entered after the puncture of its capsule. Real-time safe.
EnteredLabels move_tip(InsertionPath& path, const PatientNow& now, double rest_mm, std::uint8_t loading) noexcept;

/// The insertion ends when the tip (of the volume proxy: the proxy) is this far out.
inline constexpr double kLeaveSkin_mm = 0.5;
/// Ends the insertion: stores the channel, closes the path. Real-time safe.
void leave_body(InsertionPath& path) noexcept;

/// Treats a needle inside the body as inserted along its axis, with all layers down to the tip pierced (safe start: no
/// force step), except bone in which the tip is less than 5 mm deep. Returns false if the tip is outside. Takes about
/// 100 us, once. Real-time safe.
bool resume_inside(InsertionPath& path, const PatientNow& now, const Vec3& tip_P, const Vec3& axis_P) noexcept;

}  // namespace trocar::haptics
