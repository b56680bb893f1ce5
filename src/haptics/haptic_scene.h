#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>

#include "anatomy/patient.h"
#include "anatomy/tissue_table.h"
#include "core/result.h"
#include "geometry/pose.h"
#include "haptics/insertion_law.h"
#include "haptics/path_constraint.h"

namespace trocar {

/// What a device senses and can bear. Defaults: PHANTOM Premium 1.5 High Force 6DOF (paper B, section 2.1).
struct DeviceCapability {
  double peak_force_n = 37.5;
  double peak_torque_nmm = 515.0;
  double max_stiffness_n_per_mm = 3.5;  ///< Range 0.1..20. Source: vendor's nominal figure, references.md.
  double stylus_weight_n = 0.5;         ///< Weight that links and stylus put on the hand. Range 0..5. [assumed]
  double stylus_lever_mm = 20.0;        ///< Centre of that weight behind the stylus origin, along -z of S. [assumed]
};

/// Spring and damper between device and virtual needle, along the axis (physics.md V1). Range: stiffness at most the
/// device's. Values: references.md, steady within 0.3 N on a bare 45-150 g mass.
struct CouplingParams {
  double stiffness_n_per_mm = 1.0;
  double damping_ns_per_mm = 0.004;
};

/// Whose weight is compensated, and switches for study.
struct InsertionOptions {
  CouplingParams coupling;
  PathConstraintParams constraint;
  bool has_stick = true;  ///< Karnopp holding force (physics.md F3).
  bool has_weight_compensation = true;
  std::uint64_t seed = 1;  ///< Of the friction's fluctuation.
};

struct NeedleGeometry {
  double radius_mm = 0.635;  ///< Range 0.1..2.5.
  double length_mm = 150.0;  ///< Stylus origin to tip. Range 20..300.
};

inline constexpr int kMaxTissues = 32;
inline constexpr int kMaxLayers = 16;
inline constexpr std::uint8_t kNoLayer = 0xff;

/// Tissue and layer numbers as the tick reads them: no text, fixed size.
struct TissueLaw {
  double viscosity_ns_per_mm = 0.0;
  double noise_n = 0.0;  ///< delta * mu
  double stick_n_per_mm = 0.0;
  double cutting_n = 0.0;
  std::uint8_t layer = kNoLayer;
};
struct LayerLaw {
  LoadingLaw loading;
  double puncture_force_n = std::numeric_limits<double>::infinity();
};

/// Everything the tick reads and never changes. Built off-line, shared, read by many threads.
struct HapticScene {
  std::shared_ptr<const VirtualPatient> patient;
  std::array<TissueLaw, kMaxTissues> tissues{};
  std::array<LayerLaw, kMaxLayers> layers{};
  int tissue_count = 0;
  int layer_count = 0;
  std::array<std::uint8_t, 256> tissue_of_label{};  ///< By label id.
  std::uint8_t skin = 0;
  double skin_thickness_mm = 2.0;
  NeedleGeometry needle;
  DeviceCapability device;
  InsertionOptions options;
  Pose X_PD;                       ///< Device base in the patient.
  Pose X_SN;                       ///< Needle in the stylus: tip at +z, length_mm from the stylus origin.
  Vec3 gravity_P = Vec3::UnitY();  ///< Unit, downwards: a supine patient lies on +y.
};

/// Checks every number and builds the scene. Errors: coupling or constraint stiffer than the device, numbers out of
/// range, too many tissues, a label whose tissue the table does not know, a patient without labels or skin distance.
Result<std::shared_ptr<const HapticScene>> make_haptic_scene(std::shared_ptr<const VirtualPatient> patient,
                                                             const TissueTable& tissues, const NeedleGeometry& needle,
                                                             const DeviceCapability& device = {},
                                                             const InsertionOptions& options = {});

/// What lies at a point of the resting anatomy. Real-time safe.
struct TissueAt {
  std::uint8_t tissue = 0;  ///< 0: air.
  std::uint8_t label = 0;
};
TissueAt tissue_at(const HapticScene& scene, const Vec3& p_P) noexcept;

}  // namespace trocar
