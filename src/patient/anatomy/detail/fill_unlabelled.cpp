#include "anatomy/detail/fill_unlabelled.h"

#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/detail/body_fields.h"
#include "anatomy/detail/merge_small_parts.h"
#include "anatomy/tissue/detail/smooth_hu.h"
#include "anatomy/tissue/detail/tissue_ranges.h"
#include "core/check.h"
#include "core/parallel.h"
#include "volume/morphology.h"
#include "volume/sampling.h"

namespace trocar::anatomy::detail {
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
FillIds choose_ids(const LabelTable& table) {
  std::uint8_t next = table.labels.empty() ? 1 : static_cast<std::uint8_t>(table.labels.back().id + 1);
  std::array<std::uint8_t, 6> ids{};
  for (std::size_t n = 0; n < ids.size(); ++n) {
    const Label* label = table.find(kFillNames[n]);
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
void restore_air_walls(const LabelTable& table, const FillIds& ids, volume::LabelGrid& labels) {
  std::array<bool, 256> is_air{};
  for (const Label& label : table.labels) is_air[label.id] = label.tissue == "lung";
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

void add_used(const FillIds& ids, const volume::LabelGrid& labels, const KnownStructures& known, LabelTable& table) {
  std::array<bool, 256> used{};
  for (const std::uint8_t id : labels.voxels) used[id] = true;
  for (std::size_t n = 0; n < kFillNames.size(); ++n) {
    const std::uint8_t id = ids.all()[n];
    if (!used[id] || table.find(id) != nullptr) continue;
    const KnownStructure* structure = known.find(kFillNames[n]);
    TROCAR_ASSERT(structure != nullptr);
    table.labels.push_back({id, std::string(kFillNames[n]), structure->tissue, structure->color, true});
  }
}

}  // namespace

Status check_fill_names(const KnownStructures& known) {
  for (const std::string_view name : kFillNames)
    if (known.find(name) == nullptr)
      return fail("the structure \"" + std::string(name) + "\", which is found from HU, is not known", known.file(),
                  "add the name to an entry [[structures]]");
  return {};
}

void fill_unlabelled(const volume::CtGrid& ct, const volume::FloatGrid& skin_distance_mm, volume::LabelGrid& labels,
                     LabelTable& table, const KnownStructures& known) {
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

}  // namespace trocar::anatomy::detail
