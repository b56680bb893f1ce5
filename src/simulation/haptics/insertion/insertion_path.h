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

/// A needle flatter to the skin than this does not pierce it: cosine of 80 degrees to the normal.
inline constexpr double kGrazing = 0.17;

/// Signed distance (mm, in P, also where motion compresses the tissue) to the undented skin, negative inside the body,
/// and the unit normal into the body. Real-time safe.
double skin_distance_mm(const PatientNow& now, const Vec3& p_P) noexcept;
Vec3 inward_normal(const PatientNow& now, const Vec3& p_P) noexcept;
/// The point of the undented skin nearest to a point close to it. Real-time safe.
Vec3 nearest_skin(const PatientNow& now, const Vec3& p_P) noexcept;
/// Where the way from a point outside the body to one inside meets the skin. Real-time safe.
Vec3 meet_skin(const PatientNow& now, const Vec3& outside_P, const Vec3& inside_P) noexcept;

/// The tip on unpierced skin (physics.md V2): the point of the undented skin that it holds, and the way from there to
/// the device's tip. The force is along that way and depends on its length alone, one energy; the point slides on the
/// skin where the force leaves the cone of friction, which only dissipates.
struct SkinContact {
  Vec3 anchor_P = Vec3::Zero();  ///< On the undented skin.
  Vec3 anchor_A = Vec3::Zero();  ///< The same point at rest; used where the patient moves.
  Vec3 way_P = Vec3::UnitZ();    ///< Unit, from there to the device's tip; into the body.
  double to_device_mm = 0.0;     ///< Length of that way; negative: the device's tip is that far outside the skin.
  Vec3 slides_P = Vec3::Zero();  ///< Velocity of that point, mm/s, smoothed like the device's; with the patient's.
};

/// Velocities of the device are smoothed so long against the ripple of encoder counts. [assumed]
inline constexpr double kVelocitySmoothing_s = 0.002;

/// Begins a contact at a point of the undented skin. Real-time safe.
SkinContact begin_contact(const PatientNow& now, const Vec3& anchor_P) noexcept;

/// Follows the device's tip for a tick, with the coefficient of friction `friction`. Real-time safe.
void follow_skin(SkinContact& contact, const PatientNow& now, const Vec3& device_tip_P, double friction,
                 double dt_s) noexcept;

/// Share of a force along the contact's way that pushes a needle with this unit axis along its axis: its cosine; 0 for
/// a needle that is flat on the skin or pushed sideways, which does not pierce.
double piercing_share(const SkinContact& contact, const PatientNow& now, const Vec3& axis_P) noexcept;

/// The soft tissue below a layer that the tip presses on: cells in series along the needle, each of which is compressed
/// under its share of the load (physics.md P6). Fixed size; no cell: rigid.
struct SoftColumn {
  int cells = 0;
  double area_mm2 = 1.0;  ///< Of the disc that carries the load.
  std::array<double, kColumnCells> thickness_mm{};
  std::array<double, kColumnCells> share{};            ///< Share of the load at the cell's depth, 0..1.
  std::array<double, kColumnCells> plane_n_per_mm2{};  ///< E/(1 - nu^2) > 0.

  /// Depression (mm) of the column's surface under a force (N); 0 for a force <= 0. Concave and bounded by the column's
  /// length: soft tissue cannot be compressed to less than nothing. Real-time safe.
  double depression_mm(double force_n) const noexcept;
};

/// Column of the tissue along `inward_P` (unit) from a point on a layer, loaded over a disc. Ends at rigid tissue, at
/// fluid or gas (modulus 0: they are displaced, not compressed) or after kColumn_mm. Soft tissue has at least the
/// modulus `least_kpa`. Real-time safe.
SoftColumn soft_column(const PatientNow& now, const Vec3& surface_P, const Vec3& inward_P, double radius_mm,
                       double least_kpa = 0.0) noexcept;

/// Time constant with which the compressed tissue recoils after a puncture. Range 0.05..0.5. [assumed]
inline constexpr double kTissueRecoil_s = 0.2;

}  // namespace trocar::haptics
