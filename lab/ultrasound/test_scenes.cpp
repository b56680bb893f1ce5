#include "lab/ultrasound/test_scenes.h"

#include <cmath>
#include <utility>

namespace trocar::ultrasound {
namespace {

constexpr double kSilent_db = -80.0;
/// Impedance of the common medium divided by a speed: the density at which a border has no reflection.
constexpr double kCommonImpedance = 1540.0 * 1000.0;

AcousticTissue medium_named(std::string name, double backscatter_db, double attenuation) {
  AcousticTissue tissue;
  tissue.name = std::move(name);
  tissue.speed_m_per_s = 1540.0;
  tissue.density_kg_per_m3 = 1000.0;
  tissue.attenuation_db_per_cm_mhz = attenuation;
  tissue.backscatter_db = backscatter_db;
  tissue.roughness = 0.0;
  return tissue;
}

AcousticTissue with_speed(std::string name, double speed_m_per_s) {
  AcousticTissue tissue = medium_named(std::move(name), 0.0, 0.0);
  tissue.speed_m_per_s = speed_m_per_s;
  tissue.density_kg_per_m3 = kCommonImpedance / speed_m_per_s;
  return tissue;
}

AcousticTissue with_density(std::string name, double density_kg_per_m3) {
  AcousticTissue tissue = medium_named(std::move(name), 0.0, 0.0);
  tissue.density_kg_per_m3 = density_kg_per_m3;
  return tissue;
}

AcousticTissue gas_named(std::string name) {
  AcousticTissue gas = medium_named(std::move(name), kSilent_db, 40.0);
  gas.speed_m_per_s = 343.0;
  gas.density_kg_per_m3 = 1.2;
  return gas;
}

bool is_in(const TestRod& rod, const Vec3& p_P) {
  return std::hypot(p_P.x() - rod.x_mm, p_P.y() - rod.y_mm) < rod.radius_mm && std::abs(p_P.z()) < rod.half_length_mm;
}

Vec3 normal_of(const TestPlane& plane) {
  return {std::sin(plane.tilt_rad), std::cos(plane.tilt_rad), 0.0};
}

double behind_mm(const TestPlane& plane, const Vec3& p_P) {
  return normal_of(plane).dot(p_P - Vec3(0.0, plane.y_mm, 0.0));
}

ScenePtr painted(const SceneBox& box, const TissueAt& tissue_at, std::vector<AcousticPoint> points = {}) {
  AcousticScene scene = paint_scene(box, test_table(), tissue_at);
  scene.points = std::move(points);
  return std::make_shared<const AcousticScene>(std::move(scene));
}

}  // namespace

AcousticTable test_table() {
  AcousticTissue bone = medium_named("bone", -10.0, 10.0);
  bone.speed_m_per_s = 3500.0;
  bone.density_kg_per_m3 = 1900.0;
  AcousticTissue lossy = medium_named("lossy", 0.0, 0.8);
  lossy.attenuation_exponent = 1.2;
  AcousticTable table;  // In the order of TestTissue.
  table.tissues = {gas_named("air"),
                   medium_named("water", kSilent_db, 0.0),
                   medium_named("tissue", 0.0, 0.5),
                   medium_named("lossless", 0.0, 0.0),
                   lossy,
                   medium_named("minus-12", -12.0, 0.5),
                   medium_named("minus-6", -6.0, 0.5),
                   medium_named("plus-6", 6.0, 0.5),
                   medium_named("plus-12", 12.0, 0.5),
                   bone,
                   gas_named("gas"),
                   with_speed("fast", 1640.0),
                   with_speed("slow", 1450.0),
                   with_density("dense", 1200.0),
                   with_density("denser", 2000.0)};
  return table;
}

ScenePtr homogeneous_scene(const SceneBox& box, TestTissue tissue) {
  return painted(box, [=](const Vec3&) { return index_of(tissue); });
}

ScenePtr points_scene(const SceneBox& box, TestTissue medium, std::vector<AcousticPoint> points) {
  return painted(
      box, [=](const Vec3&) { return index_of(medium); }, std::move(points));
}

ScenePtr layers_scene(const SceneBox& box, std::span<const TestLayer> layers, std::vector<AcousticPoint> points) {
  const auto tissue_at = [layers](const Vec3& p_P) {
    for (const TestLayer& layer : layers)
      if (p_P.y() < layer.to_y_mm) return index_of(layer.tissue);
    return index_of(layers.back().tissue);
  };
  return painted(box, tissue_at, std::move(points));
}

ScenePtr rods_scene(const SceneBox& box, TestTissue medium, std::span<const TestRod> rods,
                    std::vector<AcousticPoint> points) {
  const auto tissue_at = [rods, medium](const Vec3& p_P) {
    for (const TestRod& rod : rods)
      if (is_in(rod, p_P)) return index_of(rod.tissue);
    return index_of(medium);
  };
  return painted(box, tissue_at, std::move(points));
}

ScenePtr slab_scene(const SceneBox& box, TestTissue medium, const TestSlab& slab) {
  return painted(box, [=](const Vec3& p_P) {
    const bool is_in_slab =
        std::abs(p_P.x()) < slab.half_width_mm && p_P.y() > slab.from_y_mm && p_P.y() < slab.to_y_mm;
    return index_of(is_in_slab ? slab.tissue : medium);
  });
}

ScenePtr plane_scene(const SceneBox& box, TestTissue medium, const TestPlane& plane, std::span<const TestRod> rods,
                     std::vector<AcousticPoint> points) {
  const auto tissue_at = [=](const Vec3& p_P) {
    if (behind_mm(plane, p_P) > 0.0) return index_of(plane.behind);
    for (const TestRod& rod : rods)
      if (is_in(rod, p_P)) return index_of(rod.tissue);
    return index_of(medium);
  };
  return painted(box, tissue_at, std::move(points));
}

Vec3 mirrored(const Vec3& p_P, const TestPlane& plane) {
  return p_P - 2.0 * behind_mm(plane, p_P) * normal_of(plane);
}

ScenePtr gap_scene(const SceneBox& box, TestTissue tissue, double from_x_mm, double gap_mm) {
  const auto skin_distance = [=](const Vec3& p_P) { return (p_P.x() > from_x_mm ? gap_mm : 0.0) - p_P.y(); };
  return std::make_shared<const AcousticScene>(paint_scene(
      box, test_table(), [=](const Vec3&) { return index_of(tissue); }, skin_distance));
}

}  // namespace trocar::ultrasound
