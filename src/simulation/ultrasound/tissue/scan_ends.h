#pragma once

#include <vector>

#include "anatomy/patient.h"
#include "geometry/pose.h"
#include "image/image.h"
#include "ultrasound/probe/scan_geometry.h"

namespace trocar::ultrasound {

/// A plane where the CT ends within the body. Points with normal_P · p_P > offset_mm were not scanned: a simulated
/// picture has no echoes there, but this is not a shadow. Frame P, mm.
struct ScanEnd {
  Vec3 normal_P{0, 0, 1};
  double offset_mm = 0.0;
};

/// The faces of the CT that cut the body: at most six. Beyond the other faces is air.
std::vector<ScanEnd> find_scan_ends(const anatomy::VirtualPatient& patient);

bool is_unscanned(const std::vector<ScanEnd>& ends, const Vec3& p_P) noexcept;

/// Share of the picture's area that lies beyond the ends, 0..1.
double unscanned_share(const std::vector<ScanEnd>& ends, const Pose& X_PT, const ScanGeometry& scan) noexcept;

/// Part of the image plane (x, y of T) within all ends: a convex polygon that extends beyond the scan where no end cuts
/// it. Empty if nothing was scanned.
std::vector<Vec2> scanned_polygon_T(const std::vector<ScanEnd>& ends, const Pose& X_PT, const ScanGeometry& scan);

/// Hatches the part of the scan that was not scanned by the CT.
void hatch_unscanned(image::RgbImage& image, const RasterGeometry& raster, const ScanGeometry& scan, const Pose& X_PT,
                     const std::vector<ScanEnd>& ends);

}  // namespace trocar::ultrasound
