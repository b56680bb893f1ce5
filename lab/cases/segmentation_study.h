#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "anatomy/tissue/tissue_table.h"
#include "cases/force_curve.h"
#include "core/progress.h"
#include "core/result.h"
#include "haptics/haptic_scene.h"

namespace trocar::cases {

/// Tissues that stay labelled in a partly segmented patient (the study of the Luebeck group: references.md, Sci Rep
/// 2017): bones, the liver with its lesions, the vessels. The skin is a distance, not a label, and stays too. Rib
/// cartilage is not among them: a bone threshold does not find it.
inline constexpr std::string_view kPartlySegmented[] = {"bone", "liver", "liver_lesion", "vessel"};

/// The rest of the body, which is not segmented.
enum class Rest {
  kFound,       ///< As a build leaves it: fat, muscle, gas, lung or soft tissue by HU and position.
  kUnlabelled,  ///< No label: all forces follow from HU.
};

/// The patient that a build makes of the same CT, skin included, if only structures of these tissues are segmented
/// (patient_builder::with_segmented_only): thin structures of the kinds that `full` has are derived again from what is
/// segmented and found. Errors: no structure data.
Result<anatomy::VirtualPatient> partly_segmented(const anatomy::VirtualPatient& full,
                                                 std::span<const std::string_view> tissues, Rest rest = Rest::kFound);

/// `count` of `available` numbers, spread evenly over all of them, in rising order; all of them if there are fewer.
std::vector<std::size_t> spread_choice(std::size_t available, std::size_t count, std::uint64_t seed);

/// Limits of a motion along a path; each path has its own drift and tilt within them.
struct StudyMotion {
  double speed_mm_per_s = 10.0;
  double max_drift_mm = 1.0;   ///< Drift of the tip at the target. [assumed]
  double max_tilt_rad = 0.02;  ///< [assumed]
  std::uint64_t seed = 1;
};
PrescribedMotion study_motion(const Segment& line_P, std::size_t number, const StudyMotion& study);

/// Where on a path the two scenes differ: in the first scene, the tissue that the needle's tip had reached, the tissue
/// against which the device's tip pushed it, and how far the device had moved past the skin.
struct ErrorPlace {
  double time_s = 0.0;  ///< From the start of the motion.
  double depth_mm = 0.0;
  std::uint8_t tissue = 0, ahead = 0;
  std::uint8_t layer = haptics::kNoLayer;  ///< Layer, or kBorder, that gave way within kGiveWay_s in one scene only.
};
/// In place of a layer: a border in the CT, as the one of fat and muscle, which the proxy models render without a
/// label.
inline constexpr std::uint8_t kBorder = haptics::kNoLayer - 1;

/// Difference between two scenes on one path: wrench on the device (force in N, torque about the grip in N mm, without
/// the stylus' weight), over the ticks in which the tip is past the skin.
struct PathError {
  int ticks = 0;
  double rms_n = 0.0, max_n = 0.0;
  double torque_rms_nmm = 0.0, torque_max_nmm = 0.0;
  int affected = 0;                           ///< Ticks with |dF| > max(kAffected_n, kAffectedShare |F|).
  double full_rms_n = 0.0, full_max_n = 0.0;  ///< |F| of the first scene.
  ErrorPlace worst;                           ///< Of max_n.
  /// Largest difference apart from the moments at which a layer or a border in the CT gives way in both scenes: without
  /// the ticks from kGiveWay_s before to kGiveWay_s after it gives way in both within kSamePlace_mm of the device's
  /// way. One that gives way in only one scene counts.
  double max_apart_n = 0.0;
  ErrorPlace worst_apart;  ///< Of max_apart_n.
  Segment line_P{Vec3::Zero(), Vec3::Zero()};
};
inline constexpr double kAffected_n = 0.05;
inline constexpr double kAffectedShare = 0.07;  ///< Force JND (Pang, Tan, Durlach; references.md).
inline constexpr double kGiveWay_s = 0.020;     ///< Before and after the puncture of a layer. [assumed]
inline constexpr double kSamePlace_mm = 0.2;    ///< Of the device's way. [assumed]
/// A border in the CT gives way when the tip starts to move this many times as fast as the device. [assumed]
inline constexpr double kSuddenly = 10.0;

/// Drives both scenes with the same poses along every path. Parallel over paths; the result does not depend on the
/// number of threads. The scenes must differ in their patients only.
std::vector<PathError> compare_forces(const haptics::HapticScene& full, const haptics::HapticScene& partly,
                                      std::span<const PrescribedMotion> motions, const Progress& progress = {});

/// The figures of the study, over paths.
struct StudyFigures {
  std::size_t paths = 0;
  double mean_rms_n = 0.0, mean_max_n = 0.0, max_n = 0.0;
  double mean_torque_rms_nmm = 0.0, max_torque_nmm = 0.0;
  double affected = 0.0;  ///< Share of all ticks, 0..1.
  double mean_full_rms_n = 0.0;
};
StudyFigures study_figures(std::span<const PathError> errors);

/// Places of the worst ticks: "adipose > muscle" (the tip still in adipose, pushed against muscle), most often first.
struct WorstPlace {
  std::string place;
  int paths = 0;
  double mean_max_n = 0.0, max_n = 0.0;
};
std::vector<WorstPlace> worst_places(std::span<const PathError> errors, const anatomy::TissueTable& tissues);

}  // namespace trocar::cases
