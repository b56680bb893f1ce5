#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "haptics/haptic_scene.h"
#include "haptics/insertion/channel.h"

namespace trocar::haptics {

/// Labels that the tip entered in a step, 0 = none.
struct EnteredLabels {
  std::array<std::uint8_t, 3> labels{};
  bool is_overflown = false;
};

/// The way of the needle into the body, the same for every force model: the line it keeps to once the skin is open, how
/// far the tip has come on it, and the holes of past insertions. Fixed size.
struct InsertionPath {
  bool is_open = false;    ///< The skin is pierced: the needle keeps to channel's line.
  Channel channel;         ///< Of this insertion.
  ChannelMemory memory;    ///< Holes of past insertions.
  double rest_mm = 0.0;    ///< Tip along the line in the resting anatomy: at the surface while a layer is loaded.
  double travel_mm = 0.0;  ///< Way of the tip through the resting tissue, in and out.
  std::uint8_t label = 0;  ///< At the tip.
  std::array<double, kMaxTissues> inserted_mm{};  ///< Shaft length in each tissue.
  Vec3 contact_to_puncture_P = Vec3::Zero();      ///< PX_p of paper A; zero before the skin gives way.
};

/// Distance (mm) along the axis from the tip to the resting skin; negative when the tip is below it. Nothing when the
/// skin is not near, or the axis only grazes it. Real-time safe.
std::optional<double> distance_to_skin_along(const HapticScene& scene, const Vec3& tip_P, const Vec3& axis_P) noexcept;

/// Puts a fresh channel on a line. Real-time safe.
void start_channel(InsertionPath& path, const Vec3& origin_P, const Vec3& direction_P) noexcept;

/// Opens the path at the skin, on the channel's line. Real-time safe.
void open_path(InsertionPath& path, std::uint8_t skin_layer) noexcept;

/// Moves the tip in the resting anatomy: shaft lengths, labels entered, depth cut. A label is entered when the tip is
/// beyond its border and `loading`, the layer that the tip indents (kNoLayer: none), is not the one over it: a liver is
/// entered after its capsule gave way. Real-time safe.
EnteredLabels move_tip(InsertionPath& path, const HapticScene& scene, double rest_mm, std::uint8_t loading) noexcept;

/// The needle is out: the hole is remembered, the path closed. Real-time safe.
void leave_body(InsertionPath& path) noexcept;

/// A needle that is found inside the body is taken as inserted along its axis, with everything down to its tip pierced
/// (safe start: no force step). False where the tip is not inside. Takes some 100 us, once. Real-time safe.
bool resume_inside(InsertionPath& path, const HapticScene& scene, const Vec3& tip_P, const Vec3& axis_P) noexcept;

}  // namespace trocar::haptics
