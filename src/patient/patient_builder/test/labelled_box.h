#pragma once

#include <string>

#include "anatomy/known_structures.h"
#include "anatomy/patient.h"
#include "anatomy/testing/shipped_structures.h"
#include "core/result.h"

namespace trocar::patient_builder {

/// A patient of one box of tissue on a grid of 1 mm, to be filled with shapes. The skin lies in front of it, at the
/// lowest y.
struct LabelledBox {
  anatomy::VirtualPatient patient;
  anatomy::KnownStructures known = trocar::testing::shipped_structures();

  LabelledBox(const volume::Index3& size, const Vec3& origin_P, const char* filling = "muscle") {
    volume::GridGeometry g;
    g.size = size;
    g.origin_P = origin_P;
    patient.ct = volume::CtGrid(g, 40);
    patient.labels = volume::LabelGrid(g);
    patient.skin_distance_mm = volume::FloatGrid(g);
    for (std::size_t n = 0; n < g.voxel_count(); ++n)
      patient.skin_distance_mm.voxels[n] = static_cast<float>(-1 - g.index_of(n)[1]);
    const std::uint8_t id = add(filling, true);
    for (std::uint8_t& voxel : patient.labels.voxels) voxel = id;
  }

  /// A new row of the label table.
  std::uint8_t add(const std::string& name, bool is_derived = false) {
    const anatomy::KnownStructure* structure = known.find(name);
    TROCAR_CHECK(structure != nullptr);
    const auto id = static_cast<std::uint8_t>(patient.label_table.labels.size() + 1);
    patient.label_table.labels.push_back({id, name, structure->tissue, structure->color, is_derived});
    return id;
  }
  std::uint8_t id_of(const std::string& name) const {
    const anatomy::Label* label = patient.label_table.find(name);
    return label != nullptr ? label->id : std::uint8_t{0};
  }

  /// Gives the voxels whose centre is inside a shape a label, which is added if it is new. Name "": no label.
  void paint(const std::string& name, const auto& is_inside) {
    std::uint8_t id = id_of(name);
    if (id == 0 && !name.empty()) id = add(name);
    const volume::GridGeometry& g = patient.labels.geometry;
    for (std::size_t n = 0; n < g.voxel_count(); ++n) {
      const volume::Index3 ijk = g.index_of(n);
      if (is_inside(g.centre_mm(ijk))) patient.labels.voxels[n] = id;
    }
  }

  std::string name_at(const Vec3& p_P) const {
    const anatomy::Label* label = anatomy::find_label(patient, p_P);
    return label != nullptr ? label->name : "";
  }
  std::size_t count(const std::string& name) const {
    const std::uint8_t id = id_of(name);
    std::size_t voxels = 0;
    for (const std::uint8_t voxel : patient.labels.voxels) voxels += id != 0 && voxel == id ? 1 : 0;
    return voxels;
  }
  /// Calls visit(p_P) for each voxel of a label.
  void for_each(const std::string& name, const auto& visit) const {
    const std::uint8_t id = id_of(name);
    const volume::GridGeometry& g = patient.labels.geometry;
    for (std::size_t n = 0; id != 0 && n < g.voxel_count(); ++n) {
      const volume::Index3 ijk = g.index_of(n);
      if (patient.labels.voxels[n] == id) visit(g.centre_mm(ijk));
    }
  }
};

}  // namespace trocar::patient_builder
