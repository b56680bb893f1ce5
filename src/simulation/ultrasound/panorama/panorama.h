#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/background_job.h"
#include "core/result.h"
#include "geometry/pose.h"
#include "ultrasound/scanner/display_settings.h"
#include "volume/grid.h"

namespace trocar::ultrasound {

/// Properties of a panorama's gray values.
struct PanoramaOptions {
  double dynamic_range_db = 60.0;     ///< Range 20..100.
  GrayMap gray_map = GrayMap::kSoft;  ///< By which the levels became gray.
  double fade_mm = 6.0;               ///< Width of the border in which its weight falls to 0. Range 1..30. Assumed.
};

/// A volume of stitched ultrasound, prepared for PanoramaEngine; immutable, shared by all engines. Frame U, mm, is that
/// of the volume; the grid's "P" is U here.
struct Panorama {
  volume::GridGeometry geometry;
  /// Level of each voxel, level_db(); 0: never imaged. A few zeros follow the last voxel.
  std::vector<std::uint8_t> levels;
  /// Weight of each voxel / 255: 0 where never imaged and next to it, rises smoothly to 1 at fade_mm from there.
  std::vector<std::uint8_t> weights;
  Pose X_PU;
  double floor_db = -45.0;  ///< Level of the darkest imaged voxel.
  double step_db = 0.25;    ///< Between levels.
  /// Level of soft tissue: median of the imaged voxels with echoes. A needle is drawn relative to it, because the gain
  /// of the acquisition is unknown. Range -30..15.
  double tissue_db = 0.0;

  /// dB after TGC relative to liver's speckle. level >= 1.
  double level_db(std::uint8_t level) const noexcept { return floor_db + (level - 1) * step_db; }
};

/// Prepares a panorama. `gray_U`: 0 where never imaged, else 1..255; X_PU maps points of the panorama to the patient.
/// A gray value becomes the level that the scanner shows with this gray value at its default settings and the
/// panorama's dynamic range (docs/physics.md U17). Errors: no imaged voxel, more than 2^31 voxels, a value out of
/// range.
Result<std::shared_ptr<const Panorama>> make_panorama(const volume::LabelGrid& gray_U, const Pose& X_PU,
                                                      const PanoramaOptions& options = {});

/// Panorama of a patient, loaded in the background at its first use: it is as large as the CT, and only its engine
/// needs it. One thread makes all calls, e.g. that of the window.
class PanoramaOnDemand {
 public:
  using Load = std::function<Result<std::shared_ptr<const Panorama>>()>;

  explicit PanoramaOnDemand(Load load) : load_(std::move(load)) {}

  /// False if loading has failed.
  bool is_possible() const noexcept { return is_possible_; }
  /// Starts loading at the first call. Returns null until it is done, and if it has failed (the log has the reason).
  std::shared_ptr<const Panorama> poll();
  bool is_loading() const noexcept { return job_.has_work(); }

 private:
  Load load_;
  BackgroundJob<std::shared_ptr<const Panorama>> job_;
  std::shared_ptr<const Panorama> panorama_;
  bool is_possible_ = true;
};

}  // namespace trocar::ultrasound
