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
  /// Peak of its echo in the middle of the beam, without attenuation and at any depth, relative to liver's speckle
  /// (root mean square). Range -40..80.
  double amplitude_db = 40.0;
};

/// Acoustic model of a patient at rest; immutable, shared by all scanners. Frame A, mm.
struct AcousticScene {
  /// Grid of `tissue` and `texture`; about isotropic.
  volume::GridGeometry geometry;
  /// Acoustic tissue of each voxel (index into table.tissues, 0..126), with smooth borders across the CT's slices. Bit
  /// 7 (kMixedCell) is set if the cell from this voxel to the next along i, j and k contains more than one tissue.
  std::vector<std::uint8_t> tissue;
  /// Smoothed deviation of the CT from its structure's mean, in steps of kTextureStep_hu.
  std::vector<std::int8_t> texture;
  volume::FloatGrid skin_distance_mm;  ///< Negative inside.
  AcousticTable table;
  std::vector<ScanEnd> ends;                          ///< Ends of the CT within the body; empty: none.
  std::vector<AcousticPoint> points;                  ///< In addition to the tissue's scatterers; without shadows.
  std::shared_ptr<const motion::MotionModel> motion;  ///< The patient's, kept for the frames; may be null.
};

inline constexpr std::uint8_t kMixedCell = 0x80;
inline constexpr double kTextureStep_hu = 2.0;

/// Resolution of a scene.
struct AcousticSceneOptions {
  double spacing_mm = 1.0;  ///< Range 0.3..3.
};

/// The errors of make_acoustic_scene(), without making the scene.
Status check_acoustic_scene(const anatomy::VirtualPatient& patient, const AcousticTable& table);

/// Errors: a label whose tissue has no row in the table (the message names it), more than 127 tissues, no body. All
/// voxels outside the body are air; the HU value determines the tissue of unlabelled voxels inside.
Result<std::shared_ptr<const AcousticScene>> make_acoustic_scene(const anatomy::VirtualPatient& patient,
                                                                 AcousticTable table,
                                                                 const AcousticSceneOptions& options = {},
                                                                 const Progress& progress = {});

/// Sets kMixedCell in every voxel of `tissue` (whose other bits hold tissues). For scenes built without
/// make_acoustic_scene.
void mark_mixed_cells(AcousticScene& scene);

}  // namespace trocar::ultrasound
