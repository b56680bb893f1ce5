#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"
#include "geometry/pose.h"
#include "ultrasound/probe/transducer.h"

namespace trocar::ultrasound {

enum class ScanPlane {
  kLongitudinal,  ///< +x of T towards the patient's head.
  kTransverse,    ///< +x of T towards the patient's right (from the flanks: to the back on the right side).
};

/// Treatment of bone in a view.
enum class BonePreference {
  kAvoid,   ///< No bone in the middle.
  kBeside,  ///< A free middle with a rib at either side.
  kShow,    ///< Bone is the subject of the view.
};

enum class TargetPoint {
  kMiddle,  ///< The label's voxel nearest to its centroid.
  kFacing,  ///< At the closest approach to the centre of the acoustic window.
};

/// A standard view (data/views.toml): placement of a transducer on any patient to show a structure. Directions in P
/// (LPS).
struct ProbeView {
  std::string name;  ///< "liver-right-kidney".
  std::string title;
  /// Label names; the first one that the patient has is used; '*' matches any ending.
  std::vector<std::string> targets;
  std::vector<std::string> through;  ///< Labels that the beam should pass through; may be empty.
  TargetPoint point = TargetPoint::kMiddle;
  Vec3 offset_mm = Vec3::Zero();  ///< From the target's point to the aiming point.
  Vec3 direction_P{0, -1, 0};     ///< Unit, from the target to the skin.
  ScanPlane plane = ScanPlane::kLongitudinal;
  double angle_rad = 0.0;  ///< Turns the plane about the beam (y of T), right-handed. Range -pi..pi.
  BonePreference bone = BonePreference::kAvoid;
  double pressed_mm = 5.0;              ///< Least depth of the dent at the middle of the face. Range 0..15.
  double search_mm = 20.0;              ///< Search radius along the skin for a better acoustic window. Range 0..60.
  double depth_mm = 160.0;              ///< Depth of the picture. Range 20..300.
  std::optional<double> frequency_mhz;  ///< Empty: the transducer's own. Range 1..20.
  std::optional<double> focus_mm;       ///< The same. Range 5..300.
  std::string transducer;               ///< A name of data/transducers.toml.
};

/// All views of a file. Errors name the line: unknown key, out of range, a direction of length zero.
Result<std::vector<ProbeView>> load_probe_views(const std::filesystem::path& path);

/// Target label of a view: the largest label that matches the first pattern with a match. Labels of fewer than 8 voxels
/// are ignored. Case and separators are ignored.
const anatomy::Label* find_target(const anatomy::VirtualPatient& patient, std::span<const std::string> patterns);

/// Why a patient does not offer a view: "no label liver"; empty: it does.
std::string missing_label(const anatomy::VirtualPatient& patient, const ProbeView& view);

/// Error (exit status 2): the patient lacks a label that the view needs; it names the label.
Status check_view(const anatomy::VirtualPatient& patient, const ProbeView& view);

/// Names of the views whose targets a patient has.
std::vector<std::string> possible_views(const anatomy::VirtualPatient& patient, std::span<const ProbeView> views);

/// The view of that name. Errors (exit status 2): an unknown name, with all names; a patient who lacks its target, with
/// the views that he has.
Result<ProbeView> choose_view(const anatomy::VirtualPatient& patient, std::span<const ProbeView> views,
                              std::string_view name);

/// Visible share of a view's subject, and shares by the cause of invisibility. The sum is 1.
struct ViewVisibility {
  double visible = 0.0;
  double behind_bone = 0.0;
  double behind_gas = 0.0;  ///< Includes lung, and air where the sound leaves the body.
  double unscanned = 0.0;   ///< Beyond an end of the CT (scan_ends.h).
  double outside_picture = 0.0;
  double too_deep = 0.0;  ///< The echo is weaker than the receiver's noise.
};

/// A view shows its subject where at least this share is visible [assumed].
inline constexpr double kEnoughVisible = 0.5;

/// Measures the part of the view's target within 40 mm of the point that the view aims at, in the image plane: its
/// area, or the surface that faces the transducer where the target is bone, lung or gas (docs/physics.md U16). Errors:
/// as choose_view for a patient without the target.
Result<ViewVisibility> measure_visibility(const anatomy::VirtualPatient& patient, const ProbeView& view,
                                          const Transducer& transducer, const Pose& X_PT);

/// Text of the causes of invisibility, the largest first: "71 % behind bone, 9 % outside the CT". Shares below half a
/// percent are left out.
std::string hidden_causes(const ViewVisibility& visibility);

}  // namespace trocar::ultrasound
