#pragma once

#include <optional>

#include "anatomy/patient.h"
#include "geometry/shapes.h"
#include "image/image.h"
#include "slices/paint_slice.h"
#include "slices/slice_geometry.h"

namespace trocar::slices {

/// A CT slice through a point, radiological view (patient's right on the left of the image; coronal and sagittal with
/// the head up, the sagittal slice with the front on the left), window/level, square pixels. Labels are filled and
/// outlined by colour, except fat, muscle and skin, which are the background of structures.
struct SlicePicture {
  image::RgbImage image;
  volume::SlicePlane plane;  ///< Pixel (u, v) lies at origin + u step_u + v step_v.
  SliceOrientation orientation = SliceOrientation::kAxial;
  /// Image position of a point in P (pixels; may be outside).
  Eigen::Vector2d to_pixel(const Vec3& p_P) const noexcept;
};
struct SliceOptions {
  Window window;
  double label_opacity = 0.25;  ///< Fill; outlines are always opaque. Range 0..1.
  bool has_outlines = true;
  int size_px = 512;  ///< Longer side. Range 1..4096.
  /// Side (mm) of the displayed square around center_P, limited to the volume; 0: the whole volume.
  double field_mm = 0.0;
  Vec3 center_P = Vec3::Zero();
};
SlicePicture make_slice_picture(const anatomy::VirtualPatient& patient, SliceOrientation orientation,
                                const Vec3& through_P, const SliceOptions& options = {});

/// Draws the orientation letters (R L A P H F) at the four edges of a slice image, as in radiology, and a scale bar
/// with its length in mm at the lower left. Text has a dark outline. Images below 96 pixels are not changed.
void draw_slice_legend(SlicePicture& picture);

/// Length of a scale bar: the largest 1, 2 or 5 x 10^n mm that fits into `most_mm` (> 0).
double scale_bar_mm(double most_mm) noexcept;

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
image::RgbImage make_slice_thumbnail(const anatomy::VirtualPatient& patient, const ThumbnailRegion& region);

/// Paints a coronal slice through the region with a border into the lower right corner of an image of at least
/// kThumbnailColumns x kThumbnailRows pixels.
void add_coronal_inset(const anatomy::VirtualPatient& patient, const ThumbnailRegion& region, image::RgbImage& image);

}  // namespace trocar::slices
