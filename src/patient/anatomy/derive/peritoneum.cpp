#include <algorithm>
#include <cmath>
#include <vector>

#include "anatomy/derive/detail/trunk_parts.h"
#include "anatomy/structure_pattern.h"
#include "core/parallel.h"
#include "volume/distance.h"
#include "volume/morphology.h"
#include "volume/resample.h"
#include "volume/sampling.h"

namespace trocar::anatomy::detail {
namespace {

constexpr double kRegionVoxelMm = 4.0;
constexpr double kAccuracyMm = 1.0;     // of the region's surface
constexpr double kNarrowMm = 16.0;      // assumed: spaces between organs up to twice this belong to the cavity
constexpr double kMembraneMm = 1.2;     // membrane and the tissue that holds it: data/phantoms/layers.toml, liver
constexpr double kDeepInsideMm = -5.0;  // assumed: lean tissue this far inside the region is no wall

/// Organs with the tissue of those in the peritoneal cavity, but outside it.
bool is_outside(std::string_view name) {
  const std::string plain = without_side(plain_name(name));
  for (const char* other : {"duodenum", "esophagus", "oesophagus", "rectum"})
    if (plain == other) return true;
  return false;
}

bool is_in_cavity(const Label& label) {
  if (is_outside(label.name)) return false;
  for (const char* tissue : {"liver", "liver_lesion", "spleen", "gallbladder", "bowel", "ascites"})
    if (label.tissue == tissue) return true;
  return false;
}

/// Steps from a voxel to those nearer than the membrane's thickness, and to those with a common face or edge: a needle
/// then cannot pass between two voxels of the membrane.
std::vector<volume::Index3> membrane_steps(const Vec3& spacing_mm) {
  std::vector<volume::Index3> steps;
  const auto reach = [&](int a) { return static_cast<std::int64_t>(kMembraneMm / spacing_mm[a]) + 1; };
  for (std::int64_t k = -reach(2); k <= reach(2); ++k)
    for (std::int64_t j = -reach(1); j <= reach(1); ++j)
      for (std::int64_t i = -reach(0); i <= reach(0); ++i) {
        const volume::Index3 step{i, j, k};
        const auto sum = std::abs(i) + std::abs(j) + std::abs(k);
        const bool is_next = sum == 1 || (sum == 2 && std::max({std::abs(i), std::abs(j), std::abs(k)}) == 1);
        if (is_next || volume::to_vec3(step).cwiseProduct(spacing_mm).norm() <= kMembraneMm) steps.push_back(step);
      }
  return steps;
}

}  // namespace

CoarseField::CoarseField(const volume::FloatGrid& field, const volume::GridGeometry& fine)
    : field_(field),
      scale_(fine.spacing_mm.cwiseQuotient(field.geometry.spacing_mm)),
      offset_(field.geometry.to_index(fine.origin_P)) {}

double CoarseField::at(const volume::Index3& ijk) const noexcept {
  return volume::sample_linear_at_index(field_, offset_ + scale_.cwiseProduct(volume::to_vec3(ijk)));
}

PeritonealRegion find_peritoneal_region(const DerivedLabels& labels) {
  PeritonealRegion region;
  for (const Label& label : labels.patient().label_table.labels) {
    if (!is_in_cavity(label)) continue;
    region.is_organ[label.id] = true;
    region.box.include(labels.boxes().box[label.id]);
  }
  if (region.box.is_empty()) return region;
  const volume::GridGeometry grid = volume::isotropic_geometry(labels.geometry(), kRegionVoxelMm);
  volume::MaskGrid organs = volume::resample_nearest(labels.patient().labels, grid, 0);
  for (std::uint8_t& voxel : organs.voxels) voxel = region.is_organ[voxel] ? 1 : 0;
  region.distance_mm = volume::signed_distance_mm(volume::erode(volume::dilate(organs, kNarrowMm), kNarrowMm));
  return region;
}

void derive_peritoneum(DerivedLabels& labels, const PeritonealRegion& region) {
  const volume::GridGeometry& g = labels.geometry();
  const IndexBox box = grown(region.box, kRegionVoxelMm + 2.0 * kMembraneMm, g);
  std::array<bool, 256> is_filling{};  // fat and soft tissue between the organs
  for (const Label& label : labels.patient().label_table.labels)
    is_filling[label.id] = label.tissue == "adipose" || label.tissue == "soft_tissue" || label.tissue == "gas";
  const CoarseField distance_mm(region.distance_mm, g);
  volume::MaskGrid cavity(cut_geometry(g, box));
  const auto rows = static_cast<std::size_t>(cavity.geometry.size[1] * cavity.geometry.size[2]);
  const auto for_rows = [&](const auto& visit) {
    parallel_for(rows, 64, [&](std::size_t first, std::size_t last) {
      for (std::size_t row = first; row < last; ++row) {
        const auto r = static_cast<std::int64_t>(row);
        const std::int64_t j = box.low[1] + r % cavity.geometry.size[1], k = box.low[2] + r / cavity.geometry.size[1];
        for (std::int64_t i = box.low[0]; i <= box.high[0]; ++i)
          visit(volume::Index3{i, j, k},
                row * static_cast<std::size_t>(cavity.geometry.size[0]) + static_cast<std::size_t>(i - box.low[0]));
      }
    });
  };
  for_rows([&](const volume::Index3& ijk, std::size_t in_box) {
    const std::uint8_t id = labels.at(g.offset(ijk));
    cavity.voxels[in_box] = region.is_organ[id] || (is_filling[id] && distance_mm.at(ijk) < -kAccuracyMm) ? 1 : 0;
  });
  const std::vector<volume::Index3> steps = membrane_steps(g.spacing_mm);
  volume::MaskGrid membrane(cavity.geometry);
  for_rows([&](const volume::Index3& ijk, std::size_t in_box) {
    if (cavity.voxels[in_box] || !labels.is_soft(labels.at(g.offset(ijk)))) return;
    const bool is_at_cavity = std::any_of(steps.begin(), steps.end(), [&](const volume::Index3& step) {
      const volume::Index3 at{ijk[0] - box.low[0] + step[0], ijk[1] - box.low[1] + step[1],
                              ijk[2] - box.low[2] + step[2]};
      return cavity.geometry.contains(at) && cavity[at];
    });
    membrane.voxels[in_box] = is_at_cavity && distance_mm.at(ijk) > kDeepInsideMm ? 1 : 0;
  });
  const std::uint8_t peritoneum = labels.add("peritoneum");
  for_each_in(g, box, [&](std::size_t n, std::size_t in_box, const volume::Index3&) {
    if (membrane.voxels[in_box]) labels.paint(n, peritoneum);
  });
}

}  // namespace trocar::anatomy::detail
