#pragma once

#include <optional>

#include "anatomy/patient.h"
#include "geometry/segment.h"
#include "volume/image.h"

namespace trocar::slices {

/// Size of a thumbnail, px.
inline constexpr int kThumbnailColumns = 320;
inline constexpr int kThumbnailRows = 200;

/// Region of a patient that a thumbnail shows. Frame P, mm.
struct ThumbnailRegion {
  Vec3 centre_P = Vec3::Zero();
  std::optional<Segment> path_P;  ///< Needle path, drawn as a line from the skin to its end.
};

/// The end of the patient's first path with this path; otherwise the middle of its largest lesion, of its liver, or of
/// the volume.
ThumbnailRegion find_thumbnail_region(const anatomy::VirtualPatient& patient);

/// An axial slice with labels through the region, and a coronal one in the corner; drawn without a graphics card.
volume::RgbImage make_slice_thumbnail(const anatomy::VirtualPatient& patient, const ThumbnailRegion& region);

/// Paints a coronal slice through the region with a border into the lower right corner of an image of at least
/// kThumbnailColumns x kThumbnailRows pixels.
void add_coronal_inset(const anatomy::VirtualPatient& patient, const ThumbnailRegion& region, volume::RgbImage& image);

}  // namespace trocar::slices
