#include "lab/ultrasound/scene_painter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "core/result.h"
#include "ultrasound/probe/scan_geometry.h"

namespace trocar::ultrasound {
namespace {

/// Margin around the scan, and air outside the skin.
constexpr double kRim_mm = 6.0;

double own_skin_distance_mm(const SceneBox& box, const Vec3& p_P) {
  if (box.face_radius_mm <= 0.0) return -p_P.y();
  return box.face_radius_mm - std::hypot(p_P.x(), p_P.y() + box.face_radius_mm);
}

/// Sag of a convex face at the edges of the box.
double sag_mm(const SceneBox& box) {
  if (box.face_radius_mm <= 0.0) return 0.0;
  const double half_mm = std::min(box.half_width_mm, box.face_radius_mm);
  return box.face_radius_mm - std::sqrt(box.face_radius_mm * box.face_radius_mm - half_mm * half_mm);
}

volume::GridGeometry grid_of(const SceneBox& box) {
  const double before_mm = kRim_mm + sag_mm(box);
  const auto whole = [&](double length_mm) { return static_cast<std::int64_t>(std::ceil(length_mm / box.spacing_mm)); };
  volume::GridGeometry grid;
  grid.spacing_mm = Vec3::Constant(box.spacing_mm);
  grid.size = {2 * whole(box.half_width_mm), whole(before_mm) + whole(box.depth_mm), 2 * whole(box.half_thickness_mm)};
  // Voxel centres are at half spacings, so that borders are at multiples of the spacing.
  grid.origin_P = box.spacing_mm * Vec3(0.5 - static_cast<double>(whole(box.half_width_mm)),
                                        0.5 - static_cast<double>(whole(before_mm)),
                                        0.5 - static_cast<double>(whole(box.half_thickness_mm)));
  return grid;
}

}  // namespace

SceneBox box_for(const Transducer& transducer, double depth_mm, double spacing_mm) {
  const ScanGeometry scan = make_scan_geometry(transducer, depth_mm, transducer.scanlines, 64);
  const ScanGeometry::Extent extent = scan.extent();
  SceneBox box;
  box.half_width_mm = extent.x1 + kRim_mm;
  box.depth_mm = depth_mm + kRim_mm;
  box.half_thickness_mm = std::max(kRim_mm, transducer.elevation_aperture_mm);
  box.spacing_mm = spacing_mm;
  box.face_radius_mm = scan.radius_mm;
  return box;
}

AcousticScene paint_scene(const SceneBox& box, AcousticTable table, const TissueAt& tissue_at,
                          const SkinDistanceAt& skin_distance_at) {
  TROCAR_CHECK(box.spacing_mm > 0.0 && box.half_width_mm > 0.0 && box.depth_mm > 0.0 && box.half_thickness_mm > 0.0);
  AcousticScene scene;
  scene.geometry = grid_of(box);
  scene.table = std::move(table);
  scene.skin_distance_mm = volume::FloatGrid(scene.geometry);
  scene.tissue.resize(scene.geometry.voxel_count());
  scene.texture.assign(scene.geometry.voxel_count(), 0);
  const volume::GridGeometry& grid = scene.geometry;
  parallel_for(scene.tissue.size(), static_cast<std::size_t>(grid.size[0]), [&](std::size_t first, std::size_t last) {
    for (std::size_t at = first; at < last; ++at) {
      const volume::Index3 ijk = grid.index_of(at);
      const Vec3 p_P = grid.centre_mm(ijk);
      const double skin_mm = skin_distance_at ? skin_distance_at(p_P) : own_skin_distance_mm(box, p_P);
      scene.skin_distance_mm.voxels[at] = static_cast<float>(skin_mm);
      scene.tissue[at] = skin_mm > 0.0 ? std::uint8_t{0} : tissue_at(p_P);
    }
  });
  mark_mixed_cells(scene);
  return scene;
}

}  // namespace trocar::ultrasound
