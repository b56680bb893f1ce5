#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "haptics/test/layered_patient.h"

namespace trocar::testing {

/// Moduli for palpation (kPa): fat and muscle soft, bone rigid.
inline anatomy::TissueTable soft_tissues(double fat_kpa = 5.0, double muscle_kpa = 20.0, double liver_kpa = 60.0) {
  anatomy::TissueTable table = paper_tissues();
  const auto set = [&](const char* name, double kpa) { table.tissues[*table.find_tissue(name)].young_kpa = kpa; };
  set("skin", fat_kpa);
  set("adipose", fat_kpa);
  set("muscle", muscle_kpa);
  set("liver", liver_kpa);
  set("bone", 1e6);
  set("soft_tissue", fat_kpa);
  return table;
}

/// Flat skin at z = 0, inside at z > 0, 1 mm voxels, 100 x 40 mm wide and 50 mm deep; a label for every voxel.
inline std::shared_ptr<anatomy::VirtualPatient> flat_patient(const std::function<std::uint8_t(const Vec3&)>& label_at) {
  auto patient = layered_patient({});
  volume::GridGeometry geometry;
  geometry.size = {101, 41, 61};
  geometry.origin_P = {-50.0, -20.0, -10.0};
  patient->ct = volume::CtGrid(geometry, 0);
  patient->labels = volume::LabelGrid(geometry, 0);
  patient->skin_distance_mm = volume::FloatGrid(geometry, 0.0F);
  for (std::size_t n = 0; n < patient->labels.voxels.size(); ++n) {
    const volume::Index3 ijk = geometry.index_of(n);
    const Vec3 p = geometry.centre_mm(ijk);
    patient->skin_distance_mm.voxels[n] = static_cast<float>(-p.z());
    if (p.z() >= 0.0) patient->labels.voxels[n] = label_at(p);
  }
  return patient;
}

inline std::shared_ptr<const haptics::HapticScene> make_face_scene(
    haptics::Tool tool, const std::function<std::uint8_t(const Vec3&)>& label_at, haptics::HapticOptions options = {},
    const anatomy::TissueTable& tissues = soft_tissues()) {
  options.tool = tool;
  auto scene = haptics::make_haptic_scene(flat_patient(label_at), tissues, {}, {}, options);
  TROCAR_CHECK(scene.has_value());
  return *scene;
}
inline std::uint8_t all_fat(const Vec3&) {
  return kFat;
}

/// Pose of the tool with its origin at a point, +y inwards (+z of P), turned about its elevation axis.
inline Pose face_down(const Vec3& p_PT, double tilt_rad = 0.0) {
  Mat3 R;
  R.col(0) = Vec3::UnitX();
  R.col(1) = Vec3::UnitZ();
  R.col(2) = -Vec3::UnitY();
  return {Eigen::AngleAxisd(tilt_rad, -Vec3::UnitY()).toRotationMatrix() * R, p_PT};
}

}  // namespace trocar::testing
