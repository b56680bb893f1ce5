#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string_view>

#include "anatomy/patient.h"
#include "anatomy/tissue/tissue_table.h"
#include "core/result.h"
#include "geometry/pose.h"
#include "haptics/contact/contact_face.h"
#include "haptics/insertion/insertion_law.h"
#include "haptics/needle_geometry.h"
#include "haptics/proxy/needle_beam.h"
#include "motion/patient_motion.h"
#include "stylus/device_preset.h"
#include "telemetry/tick_sample.h"

namespace trocar::haptics {

/// Law that computes the force (docs/physics.md T1, T2).
enum class ForceModel : std::uint8_t {
  kInsertion,  ///< Paper A: layers that are loaded and punctured, friction, cutting, path constraint.
  kProxy,      ///< Paper B: tip proxy on CT and labels, body proxies on the path, bending.
  kCombined,   ///< A's loading and cutting where a tissue has parameters, B elsewhere and for the shaft.
};
const char* to_string(ForceModel model) noexcept;
/// "insertion", "proxy", "combined"; else exit status 2.
Result<ForceModel> parse_force_model(std::string_view name);

/// Weight compensation, and switches for studies.
struct HapticOptions {
  Tool tool = Tool::kNeedle;
  ForceModel force_model = ForceModel::kInsertion;
  stylus::CouplingParams coupling;
  PathConstraintParams constraint;
  bool has_stick = true;  ///< Karnopp holding force (physics.md F3).
  bool has_weight_compensation = true;
  bool has_bending = true;     ///< Proxy and combined: false keeps the shaft straight.
  std::uint64_t seed = 1;      ///< Seed of the friction's fluctuation.
  motion::MotionDrive motion;  ///< What drives the patient's motion, in the time of the ticks.
};

inline constexpr int kMaxTissues = 32;
inline constexpr int kMaxLayers = 16;
inline constexpr std::uint8_t kNoLayer = 0xff;
inline constexpr double kNPerMm2PerKpa = 1e-3;

/// Tissue and layer parameters in the form that the tick reads: no text, fixed size.
struct TissueLaw {
  double viscosity_ns_per_mm = 0.0;
  double noise_n = 0.0;  ///< delta * mu, in proportion to the needle's diameter
  double stick_n_per_mm = 0.0;
  double cutting_n = 0.0;
  double young_kpa = 0.0;
  double friction_mu = 0.0;
  std::uint8_t layer = kNoLayer;
  bool is_read_from_ct = false;  ///< Where it has a label; see is_read_from_ct().
};
struct LayerLaw {
  LoadingLaw loading;
  double puncture_force_n = std::numeric_limits<double>::infinity();
  /// Puncture force divided by the static indentation at that force; bone: its stiffness.
  double indent_n_per_mm = 1.0;
  bool is_wall = false;            ///< Proxy models: the layer is punctured at a label's border.
  double load_spread_mm = 0.0;     ///< Above 0: the tissue below gives way (physics.md P6).
  double pressed_young_kpa = 0.0;  ///< Least Young's modulus of that tissue.
};

/// Where a patient is at a time; at rest, in phase 0, without a model or if nothing drives it. Real-time safe.
inline motion::PatientMotion motion_of(const motion::MotionClock& clock, double time_s) noexcept {
  return clock.model != nullptr && motion::moves(clock.drive) ? clock.at(time_s) : motion::PatientMotion();
}

/// Constant data of the tick. Built off-line, shared, read by many threads.
struct HapticScene {
  std::shared_ptr<const anatomy::VirtualPatient> patient;
  std::array<TissueLaw, kMaxTissues> tissues{};
  std::array<LayerLaw, kMaxLayers> layers{};
  int tissue_count = 0;
  int layer_count = 0;
  std::array<std::uint8_t, 256> tissue_of_label{};  ///< By label id.
  std::uint8_t skin = 0;
  double skin_thickness_mm = 2.0;
  anatomy::FrictionLaw friction;
  bool has_path_constraint = false;  ///< Insertion model: paper A's path constraint instead of the bending shaft.
  anatomy::HuTransfer transfer;      ///< Transfer functions of unlabelled tissue; proxy and combined.
  NeedleGeometry needle;
  ContactFace face;  ///< Face of a transducer or a finger.
  NeedleBeam beam_with_stylet;
  NeedleBeam beam_without_stylet;
  stylus::DeviceCapability device;
  HapticOptions options;
  Pose X_PW;  ///< The room in the patient.
  /// Needle in the stylus: tip at +z, length_mm from the stylus origin. For a transducer or a finger X_ST: y of T
  /// along +z of S, face.reach_mm from the stylus origin.
  Pose X_SN;
  Vec3 gravity_P = Vec3::UnitY();  ///< Unit, downwards: a supine patient lies on +y.

  /// Where the patient is at a time of the ticks; at rest without a motion model or if nothing drives it.
  /// Real-time safe.
  motion::PatientMotion motion_at(double time_s) const noexcept {
    return motion_of({patient != nullptr ? patient->motion.get() : nullptr, options.motion}, time_s);
  }
};

/// Checks every number and builds the scene. Errors: coupling or constraint stiffer than the device, numbers out of
/// range, too many tissues; a patient without skin distance, without labels (insertion), without CT or a table without
/// transfer functions (proxy, combined). A label whose tissue is not in the table is treated as soft_tissue, with a
/// warning. A transducer or a finger needs labels, or a CT and transfer functions, for every force model.
Result<std::shared_ptr<const HapticScene>> make_haptic_scene(std::shared_ptr<const anatomy::VirtualPatient> patient,
                                                             const anatomy::TissueTable& tissues,
                                                             const NeedleGeometry& needle,
                                                             const stylus::DeviceCapability& device = {},
                                                             const HapticOptions& options = {});

/// Tissue at a point of the anatomy at rest. Real-time safe.
struct TissueAt {
  std::uint8_t tissue = 0;  ///< 0: air.
  std::uint8_t label = 0;
};
TissueAt tissue_at(const HapticScene& scene, const Vec3& p_A) noexcept;

/// True for tissue that the model reads from the CT rather than from its label (physics.md T2): unlabelled tissue, and
/// in the proxy models (proxy, combined) all but the skin and structures with walls. Real-time safe.
inline bool is_read_from_ct(const HapticScene& scene, const TissueAt& here) noexcept {
  if (here.label == 0) return here.tissue != 0 && here.tissue != scene.skin;
  return scene.tissues[here.tissue].is_read_from_ct;
}

/// The patient at rest.
inline const motion::PatientMotion kAtRest{};

/// The patient as a tick sees it: constant data in the anatomy at rest (frame A), and where it is now (frame P). Forces
/// and distances of the laws are in P; tissue is looked up in A. A scene alone: the patient at rest.
struct PatientNow {
  const HapticScene& scene;
  const motion::PatientMotion& motion;

  PatientNow(const HapticScene& the_scene, const motion::PatientMotion& the_motion = kAtRest) noexcept
      : scene(the_scene), motion(the_motion) {}
};

}  // namespace trocar::haptics
