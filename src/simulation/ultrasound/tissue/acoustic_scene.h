#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"
#include "ultrasound/tissue/acoustic_table.h"
#include "ultrasound/tissue/scan_ends.h"

namespace trocar::ultrasound {

/// A single bright scatterer: a wire of a test phantom across the image, a microcalcification. Frame P, mm.
struct AcousticPoint {
  Vec3 p_P = Vec3::Zero();
  /// Peak of its echo in the middle of the beam, without attenuation and at any depth, against liver's speckle (root
  /// mean square). Range -40..80.
  double amplitude_db = 40.0;
};

/// Acoustic model of a patient in the resting anatomy; immutable, shared by all scanners. Frame P, mm.
struct AcousticScene {
  /// About isotropic: `tissue` and `texture` lie on it.
  volume::GridGeometry geometry;
  /// Acoustic tissue of each voxel (index into table.tissues, 0..126), the borders smooth across the CT's slices. Bit 7
  /// (kMixedCell) is set where the cell from this voxel to the next along i, j and k holds more than one tissue.
  std::vector<std::uint8_t> tissue;
  /// Smoothed deviation of the CT from its structure's mean, in steps of kTextureStep_hu.
  std::vector<std::int8_t> texture;
  volume::FloatGrid skin_distance_mm;  ///< Negative inside.
  AcousticTable table;
  std::vector<ScanEnd> ends;          ///< Where the CT ends within the body; empty: nowhere.
  std::vector<AcousticPoint> points;  ///< In addition to the tissue's scatterers; without shadows.
};

inline constexpr std::uint8_t kMixedCell = 0x80;
inline constexpr double kTextureStep_hu = 2.0;

/// Resolution of a scene.
struct AcousticSceneOptions {
  double spacing_mm = 1.0;  ///< Range 0.3..3.
};

/// Errors: a label whose tissue has no row in the table (named), more than 127 tissues. Outside the body is air,
/// whatever lies there; unlabelled voxels inside are what their HU say.
Result<std::shared_ptr<const AcousticScene>> make_acoustic_scene(const anatomy::VirtualPatient& patient,
                                                                 AcousticTable table,
                                                                 const AcousticSceneOptions& options = {},
                                                                 const Progress& progress = {});

/// Sets kMixedCell in every voxel of `tissue` (whose other bits hold tissues). For scenes made by hand.
void mark_mixed_cells(AcousticScene& scene);

}  // namespace trocar::ultrasound
