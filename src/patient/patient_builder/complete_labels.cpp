#include "patient_builder/complete_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "anatomy/known_structures.h"
#include "anatomy/patient.h"
#include "core/files/folders.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/result.h"
#include "patient_builder/derive/derive_structures.h"
#include "patient_builder/detail/body_fields.h"
#include "volume/grid.h"
#include "volume/morphology.h"
#include "volume/sampling.h"

namespace trocar::patient_builder::detail {

/// Error: one of the structures that fill_unlabelled assigns is not known.
Status check_fill_names(const anatomy::KnownStructures& known);

/// Assigns a label to every unlabelled voxel inside the body by its smoothed CT value and its region: "fat", "muscle",
/// "bone_other", "gas", "lung", else "soft_tissue". The used labels are added to the table. Precondition:
/// check_fill_names has passed.
void fill_unlabelled(const volume::CtGrid& ct, const volume::FloatGrid& skin_distance_mm, volume::LabelGrid& labels,
                     anatomy::LabelTable& table, const anatomy::KnownStructures& known);

/// Relabels connected parts (6 neighbours) of the labels `ids` that are smaller than `min_voxels`. Each part gets that
/// label of `ids` whose large parts it touches most; a part that touches none stays.
void merge_small_parts(volume::LabelGrid& labels, std::span<const std::uint8_t> ids, std::size_t min_voxels);

}  // namespace trocar::patient_builder::detail

namespace trocar::patient_builder {

Status check_completed_names(const anatomy::KnownStructures& known) {
  TROCAR_TRY_STATUS(detail::check_fill_names(known));
  return check_derived_names(known);
}

std::vector<std::string> complete_labels(anatomy::VirtualPatient& patient, const anatomy::KnownStructures& known,
                                         const DeriveChoice& derive, const Progress& progress) {
  report(progress, "fat and muscle", 0.0);
  detail::fill_unlabelled(patient.ct, patient.skin_distance_mm, patient.labels, patient.label_table, known);
  return derive_structures(patient, known, derive, part_of(progress, 0.4, 1.0));
}

namespace {

/// Keeps the labels for which `is_kept` is true, under the ids that `id_of(label, number)` gives; the others become 0.
void keep_labels(anatomy::VirtualPatient& patient, const auto& is_kept, const auto& id_of) {
  std::array<std::uint8_t, 256> kept{};
  std::vector<anatomy::Label> labels;
  for (anatomy::Label& label : patient.label_table.labels) {
    if (!is_kept(label)) continue;
    const std::uint8_t id = id_of(label, labels.size() + 1);
    kept[label.id] = id;
    label.id = id;
    labels.push_back(std::move(label));
  }
  patient.label_table.labels = std::move(labels);
  for (std::uint8_t& voxel : patient.labels.voxels) voxel = kept[voxel];
}

}  // namespace

Result<anatomy::VirtualPatient> with_segmented_only(const anatomy::VirtualPatient& full,
                                                    std::span<const std::string_view> tissues,
                                                    const Progress& progress) {
  TROCAR_TRY(const std::filesystem::path data_folder, checked_data_dir());
  TROCAR_TRY(const anatomy::KnownStructures known, anatomy::KnownStructures::load(data_folder));
  TROCAR_TRY_STATUS(check_completed_names(known));
  anatomy::VirtualPatient partly = full;
  keep_labels(
      partly,
      [&](const anatomy::Label& label) {
        return !label.is_derived && std::ranges::find(tissues, label.tissue) != tissues.end();
      },
      [](const anatomy::Label&, std::size_t number) { return static_cast<std::uint8_t>(number); });
  complete_labels(partly, known, derivable_in(full.label_table), progress);
  partly.content_hash = anatomy::hash_patient(partly);
  return partly;
}

void remove_found_labels(anatomy::VirtualPatient& patient) {
  keep_labels(
      patient, [](const anatomy::Label& label) { return !label.is_derived || is_derivable(label.name); },
      [](const anatomy::Label& label, std::size_t) { return label.id; });
  patient.content_hash = anatomy::hash_patient(patient);
}

}  // namespace trocar::patient_builder

namespace trocar::patient_builder::detail {
namespace {

constexpr double kMinPartMm3 = 100.0;  // assumed: smaller islands are noise and partial volume
constexpr double kLungRimMm = 3.0;     // assumed: accuracy of the coarse lung's border
constexpr double kThickSkinMm = 8.0;   // assumed: skin of the trunk is nowhere thicker
constexpr double kBeneathSkinMm = 4.0;
constexpr double kAirWallMm = 2.0;  // assumed: apparent fat this close to air is a wall with partial volume

/// Labels assigned from CT values.
constexpr std::array<std::string_view, 6> kFillNames = {"fat", "muscle", "bone_other", "gas", "lung", "soft_tissue"};

/// Their ids in this patient.
struct FillIds {
  std::uint8_t fat, muscle, bone, gas, lung, soft_tissue;
  std::array<std::uint8_t, 6> all() const { return {fat, muscle, bone, gas, lung, soft_tissue}; }  ///< As kFillNames.
};

/// The id of a name in the table, otherwise the next free one.
FillIds choose_ids(const anatomy::LabelTable& table) {
  std::uint8_t next = table.labels.empty() ? 1 : static_cast<std::uint8_t>(table.labels.back().id + 1);
  std::array<std::uint8_t, 6> ids{};
  for (std::size_t n = 0; n < ids.size(); ++n) {
    const anatomy::Label* label = table.find(kFillNames[n]);
    ids[n] = label != nullptr ? label->id : next++;
  }
  return {ids[0], ids[1], ids[2], ids[3], ids[4], ids[5]};
}

/// Position of an unlabelled voxel.
struct Place {
  bool in_wall = true;
  bool in_lung = false;
  bool at_lung = false;
};

std::uint8_t classify(int hu, const Place& place, const FillIds& ids) {
  if (place.in_lung) return ids.lung;
  if (hu < kGasBelowHu) return place.at_lung ? ids.lung : ids.gas;
  if (hu <= kFatAboveHu) return ids.soft_tissue;
  if (hu <= kFatUpToHu) return ids.fat;
  if (hu > kBoneAboveHu) return ids.bone;
  return hu <= kMuscleUpToHu && place.in_wall ? ids.muscle : ids.soft_tissue;
}

/// Samples the coarse fields at the voxels of a finer grid with the same box.
class FieldSampler {
 public:
  FieldSampler(const BodyFields& fields, const volume::GridGeometry& grid) : fields_(fields) {
    const volume::GridGeometry& coarse = fields.wall_mm.geometry;
    scale_ = grid.spacing_mm.cwiseQuotient(coarse.spacing_mm);
    offset_ = coarse.to_index(grid.origin_P);
  }

  Place at(const volume::Index3& ijk) const {
    const Vec3 index = volume::to_vec3(ijk);
    const Vec3 coarse_index = offset_ + scale_.cwiseProduct(index);
    const double lung_mm = volume::sample_linear_at_index(fields_.lung_mm, coarse_index);
    return {volume::sample_linear_at_index(fields_.wall_mm, coarse_index) < 0.0, lung_mm < -kLungRimMm,
            lung_mm < kLungRimMm};
  }

 private:
  const BodyFields& fields_;
  Vec3 scale_;
  Vec3 offset_;
};

void classify_all(const volume::CtGrid& smooth, const volume::FloatGrid& skin_distance_mm, const BodyFields& fields,
                  const FillIds& ids, volume::LabelGrid& labels) {
  const FieldSampler sampler(fields, labels.geometry);
  parallel_for(labels.voxels.size(), 1 << 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      const float distance_mm = skin_distance_mm.voxels[n];
      if (labels.voxels[n] != 0 || !(distance_mm < 0.0F)) continue;
      labels.voxels[n] = distance_mm > -kSubcutisMm
                             ? ids.fat
                             : classify(smooth.voxels[n], sampler.at(labels.geometry.index_of(n)), ids);
    }
  });
}

/// Lean tissue just below the surface with fat beneath it is thicker skin: it becomes part of the subcutis.
void remove_thick_skin(const volume::FloatGrid& skin_distance_mm, const FillIds& ids, volume::LabelGrid& labels) {
  std::vector<std::size_t> skin;
  for (std::size_t n = 0; n < labels.voxels.size(); ++n) {
    if (labels.voxels[n] != ids.muscle || skin_distance_mm.voxels[n] < -kThickSkinMm) continue;
    const volume::Index3 ijk = labels.geometry.index_of(n);
    const Vec3 p_P = labels.geometry.centre_mm(ijk);
    const Vec3 inward_P = -volume::gradient_per_mm(skin_distance_mm, p_P).normalized();
    if (volume::sample_nearest<std::uint8_t>(labels, p_P + kBeneathSkinMm * inward_P, 0) == ids.fat) skin.push_back(n);
  }
  for (const std::size_t n : skin) labels.voxels[n] = ids.fat;
}

/// Dense parts without a truly dense voxel: contrast agent.
void demote_faint_bone(const volume::CtGrid& ct, const FillIds& ids, volume::LabelGrid& labels) {
  volume::MaskGrid dense(labels.geometry);
  for (std::size_t n = 0; n < dense.voxels.size(); ++n) dense.voxels[n] = labels.voxels[n] == ids.bone ? 1 : 0;
  const volume::Components parts = volume::connected_components(dense);
  std::vector<bool> is_bone(parts.voxel_counts.size() + 1, false);
  for (std::size_t n = 0; n < dense.voxels.size(); ++n) {
    if (ct.voxels[n] >= kBonePeakHu) is_bone[static_cast<std::size_t>(parts.ids.voxels[n])] = true;
  }
  for (std::size_t n = 0; n < dense.voxels.size(); ++n) {
    if (dense.voxels[n] && !is_bone[static_cast<std::size_t>(parts.ids.voxels[n])]) labels.voxels[n] = ids.soft_tissue;
  }
}

/// Turns apparent fat between air and the surrounding tissue into soft tissue: pleura or the wall of a bowel.
void restore_air_walls(const anatomy::LabelTable& table, const FillIds& ids, volume::LabelGrid& labels) {
  std::array<bool, 256> is_air{};
  for (const anatomy::Label& label : table.labels) is_air[label.id] = label.tissue == "lung";
  is_air[ids.gas] = is_air[ids.lung] = true;
  const volume::GridGeometry& geometry = labels.geometry;
  const auto is_near_air = [&](const volume::Index3& ijk) {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto reach = static_cast<std::int64_t>(kAirWallMm / geometry.spacing_mm[static_cast<Eigen::Index>(a)]);
      for (std::int64_t step = -reach; step <= reach; ++step) {
        volume::Index3 beside = ijk;
        beside[a] += step;
        if (geometry.contains(beside) && is_air[labels[beside]]) return true;
      }
    }
    return false;
  };
  std::vector<std::size_t> walls;
  for (std::size_t n = 0; n < labels.voxels.size(); ++n) {
    if (labels.voxels[n] == ids.fat && is_near_air(geometry.index_of(n))) walls.push_back(n);
  }
  for (const std::size_t n : walls) labels.voxels[n] = ids.soft_tissue;
}

void add_used(const FillIds& ids, const volume::LabelGrid& labels, const anatomy::KnownStructures& known,
              anatomy::LabelTable& table) {
  std::array<bool, 256> used{};
  for (const std::uint8_t id : labels.voxels) used[id] = true;
  for (std::size_t n = 0; n < kFillNames.size(); ++n) {
    const std::uint8_t id = ids.all()[n];
    if (!used[id] || table.find(id) != nullptr) continue;
    const anatomy::KnownStructure* structure = known.find(kFillNames[n]);
    TROCAR_ASSERT(structure != nullptr);
    table.labels.push_back({id, std::string(kFillNames[n]), structure->tissue, structure->color, true});
  }
}

}  // namespace

Status check_fill_names(const anatomy::KnownStructures& known) {
  for (const std::string_view name : kFillNames)
    if (known.find(name) == nullptr)
      return fail("the structure \"" + std::string(name) + "\", which is found from HU, is not known", known.file(),
                  "add the name to an entry [[structures]]");
  return {};
}

void fill_unlabelled(const volume::CtGrid& ct, const volume::FloatGrid& skin_distance_mm, volume::LabelGrid& labels,
                     anatomy::LabelTable& table, const anatomy::KnownStructures& known) {
  const FillIds ids = choose_ids(table);
  const volume::CtGrid smooth = smooth_hu(ct);
  classify_all(smooth, skin_distance_mm, find_body_fields(smooth, labels, table, skin_distance_mm), ids, labels);
  remove_thick_skin(skin_distance_mm, ids, labels);
  restore_air_walls(table, ids, labels);
  demote_faint_bone(ct, ids, labels);
  const auto min_voxels = static_cast<std::size_t>(std::ceil(kMinPartMm3 / ct.geometry.voxel_volume_mm3()));
  merge_small_parts(labels, ids.all(), min_voxels);
  add_used(ids, labels, known, table);
}

namespace {

struct SmallParts {
  struct Voxel {
    std::size_t offset = 0;
    std::size_t part = 0;
  };
  std::vector<Voxel> voxels;
  std::size_t count = 0;
};

void add_small_parts(const volume::LabelGrid& labels, std::uint8_t id, std::size_t min_voxels, SmallParts& small) {
  volume::MaskGrid mask(labels.geometry);
  for (std::size_t n = 0; n < mask.voxels.size(); ++n) mask.voxels[n] = labels.voxels[n] == id ? 1 : 0;
  const volume::Components parts = volume::connected_components(mask);
  // Parts are sorted by decreasing size: the small ones come last.
  const auto first_small = std::find_if(parts.voxel_counts.begin(), parts.voxel_counts.end(),
                                        [&](std::size_t voxels) { return voxels < min_voxels; });
  const auto large_count = static_cast<std::size_t>(first_small - parts.voxel_counts.begin());
  for (std::size_t n = 0; n < parts.ids.voxels.size(); ++n) {
    const auto part = static_cast<std::size_t>(parts.ids.voxels[n]);
    if (part > large_count) small.voxels.push_back({n, small.count + part - large_count - 1});
  }
  small.count += parts.voxel_counts.size() - large_count;
}

}  // namespace

void merge_small_parts(volume::LabelGrid& labels, std::span<const std::uint8_t> ids, std::size_t min_voxels) {
  SmallParts small;
  for (const std::uint8_t id : ids) add_small_parts(labels, id, min_voxels, small);

  // Small parts are removed first, so that each is compared with large parts only.
  std::array<std::size_t, 256> column_of{};  // 0: none of `ids`
  for (std::size_t n = 0; n < ids.size(); ++n) column_of[ids[n]] = n + 1;
  const std::size_t columns = ids.size() + 1;
  std::vector<std::uint8_t> own(small.voxels.size());
  for (std::size_t n = 0; n < small.voxels.size(); ++n)
    own[n] = std::exchange(labels.voxels[small.voxels[n].offset], std::uint8_t{0});

  std::vector<std::uint32_t> contacts(small.count * columns, 0);
  for (const auto& [offset, part] : small.voxels) {
    const volume::Index3 ijk = labels.geometry.index_of(offset);
    for (std::size_t a = 0; a < 3; ++a) {
      for (const std::int64_t step : {-1, 1}) {
        volume::Index3 beside = ijk;
        beside[a] += step;
        if (labels.geometry.contains(beside)) ++contacts[part * columns + column_of[labels[beside]]];
      }
    }
  }
  for (std::size_t n = 0; n < small.voxels.size(); ++n) {
    const auto& [offset, part] = small.voxels[n];
    const std::uint32_t* first = contacts.data() + part * columns + 1;
    const std::uint32_t* most = std::max_element(first, first + ids.size());
    labels.voxels[offset] = *most == 0 ? own[n] : ids[static_cast<std::size_t>(most - first)];
  }
}

}  // namespace trocar::patient_builder::detail
