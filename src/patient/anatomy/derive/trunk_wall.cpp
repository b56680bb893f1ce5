#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "anatomy/derive/detail/trunk_parts.h"
#include "core/parallel.h"
#include "volume/distance.h"
#include "volume/morphology.h"
#include "volume/resample.h"
#include "volume/sampling.h"

namespace trocar::anatomy::detail {
namespace {

// Pleural recess: the parietal pleura reaches about 5 cm (two ribs) below the lung's edge at the side (Gray's Anatomy;
// doi 10.1055/s-0039-3401842). It lies between chest wall and diaphragm.
constexpr double kRecessMm = 50.0;
constexpr double kDiaphragmMm = 3.0;    // assumed: between the recess and the organs
constexpr double kRecessWidthMm = 2.0;  // two layers of pleura and their fluid
constexpr double kRibCageMm = 16.0;     // assumed: from a rib; half the distance between two ribs
constexpr double kCostalLungMm = 16.0;  // assumed: lung this near to a rib ends in the recess
constexpr double kFacesWall = 0.3;      // cosine between the directions to the skin and away from the organ
constexpr int kSectors = 36;

/// Directions around the axis of the trunk.
class Sectors {
 public:
  Sectors(const Vec3& axis_P, int count) : axis_P_(axis_P), count_(count) {}
  std::size_t of(const Vec3& p_P) const {
    const double angle = std::atan2(p_P.y() - axis_P_.y(), p_P.x() - axis_P_.x());
    const double share = (angle + std::numbers::pi) / (2.0 * std::numbers::pi);
    return static_cast<std::size_t>(std::clamp(static_cast<int>(share * count_), 0, count_ - 1));
  }
  std::size_t count() const { return static_cast<std::size_t>(count_); }

 private:
  Vec3 axis_P_;
  int count_;
};

std::array<bool, 256> ids_with_tissue(const DerivedLabels& labels, std::initializer_list<std::string_view> tissues) {
  std::array<bool, 256> ids{};
  for (const Label& label : labels.patient().label_table.labels)
    ids[label.id] = std::find(tissues.begin(), tissues.end(), label.tissue) != tissues.end();
  return ids;
}

/// Calcifications and clips are no ribs.
void remove_small_parts(volume::MaskGrid& mask) {
  constexpr double kSmallestMl = 1.0;
  const volume::Components parts = volume::connected_components(mask);
  const double voxel_ml = mask.geometry.voxel_volume_mm3() / 1000.0;
  for (std::size_t n = 0; n < mask.voxels.size(); ++n) {
    if (parts.ids.voxels[n] == 0) continue;
    const auto voxels = parts.voxel_counts[static_cast<std::size_t>(parts.ids.voxels[n] - 1)];
    if (static_cast<double>(voxels) * voxel_ml < kSmallestMl) mask.voxels[n] = 0;
  }
}

/// Lowest z (mm) of the lung at the ribs, by sector; infinite: no lung there.
std::vector<double> lung_edges(const volume::LabelGrid& coarse, const std::array<bool, 256>& is_lung,
                               const volume::FloatGrid& to_rib_mm, const Sectors& sectors) {
  constexpr std::size_t kMinVoxels = 3;
  std::vector<std::vector<double>> heights(sectors.count());
  for (std::size_t n = 0; n < coarse.voxels.size(); ++n) {
    if (!is_lung[coarse.voxels[n]] || to_rib_mm.voxels[n] > kCostalLungMm) continue;
    const volume::Index3 ijk = coarse.geometry.index_of(n);
    const Vec3 p_P = coarse.geometry.centre_mm(ijk);
    heights[sectors.of(p_P)].push_back(p_P.z());
  }
  std::vector<double> edges(sectors.count(), std::numeric_limits<double>::infinity());
  for (std::size_t s = 0; s < edges.size(); ++s)
    if (heights[s].size() >= kMinVoxels) edges[s] = *std::min_element(heights[s].begin(), heights[s].end());
  return edges;
}

}  // namespace

Vec3 trunk_axis(const VirtualPatient& patient) {
  const volume::GridGeometry& g = patient.skin_distance_mm.geometry;
  constexpr std::size_t kStep = 97;  // a sample is sufficient
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  for (std::size_t n = 0; n < patient.skin_distance_mm.voxels.size(); n += kStep) {
    if (!(patient.skin_distance_mm.voxels[n] < 0.0F)) continue;
    const volume::Index3 ijk = g.index_of(n);
    sum += g.centre_mm(ijk);
    count += 1.0;
  }
  return sum / std::max(count, 1.0);
}

void derive_pleural_recess(DerivedLabels& labels, const PeritonealRegion& region) {
  const volume::GridGeometry& g = labels.geometry();
  const auto is_lung = ids_with_tissue(labels, {"lung"});
  const auto is_rib = ids_with_tissue(labels, {"bone", "cartilage"});
  const volume::LabelGrid coarse = volume::resample_nearest(labels.patient().labels, region.distance_mm.geometry, 0);
  volume::MaskGrid ribs(coarse.geometry);
  for (std::size_t n = 0; n < ribs.voxels.size(); ++n) ribs.voxels[n] = is_rib[coarse.voxels[n]] ? 1 : 0;
  if (std::find(ribs.voxels.begin(), ribs.voxels.end(), 1) == ribs.voxels.end()) return;
  remove_small_parts(ribs);
  const volume::FloatGrid to_rib_mm = volume::distance_to_mask_mm(ribs);
  const Vec3 axis_P = trunk_axis(labels.patient());
  const Sectors sectors(axis_P, kSectors);
  const std::vector<double> edges = lung_edges(coarse, is_lung, to_rib_mm, sectors);

  const CoarseField organ_mm(region.distance_mm, g), rib_mm(to_rib_mm, g);
  const double outer_mm = kDiaphragmMm + std::max(kRecessWidthMm, g.spacing_mm.maxCoeff());
  const std::uint8_t left = labels.add("pleural_recess_left"), right = labels.add("pleural_recess_right");
  const IndexBox box = grown(region.box, outer_mm + kRecessWidthMm, g);
  const auto slices = static_cast<std::size_t>(box.high[2] - box.low[2] + 1);
  parallel_for(slices, 1, [&](std::size_t first, std::size_t last) {
    IndexBox part = box;
    part.low[2] = box.low[2] + static_cast<std::int64_t>(first);
    part.high[2] = box.low[2] + static_cast<std::int64_t>(last) - 1;
    for_each_in(g, part, [&](std::size_t n, std::size_t, const volume::Index3& ijk) {
      if (!labels.is_soft(labels.at(n))) return;
      const double distance_mm = organ_mm.at(ijk);
      if (distance_mm < kDiaphragmMm || distance_mm >= outer_mm || rib_mm.at(ijk) > kRibCageMm) return;
      const Vec3 p_P = g.centre_mm(ijk);
      const double below_mm = edges[sectors.of(p_P)] - p_P.z();
      if (below_mm < 0.0 || below_mm > kRecessMm) return;
      const Vec3 from_organ_P = volume::gradient_per_mm(region.distance_mm, p_P);
      if (from_organ_P.dot(volume::gradient_per_mm(labels.patient().skin_distance_mm, p_P)) < kFacesWall) return;
      labels.paint(n, p_P.x() > axis_P.x() ? left : right);
    });
  });
}

void derive_wall_structures(DerivedLabels& labels, const DeriveChoice& choice) {
  // Before the membranes, which are wider than they are in coarse voxels and would cut it.
  if (choice.has("neurovascular_bundle") && !labels.is_labelled("neurovascular_bundle"))
    derive_neurovascular_bundle(labels);
  const bool has_peritoneum = choice.has("peritoneum") && !labels.is_labelled("peritoneum");
  const bool has_recess = choice.has("pleural_recess") && !labels.is_labelled("pleural_recess_left") &&
                          !labels.is_labelled("pleural_recess_right");
  if (has_peritoneum || has_recess) {
    const PeritonealRegion region = find_peritoneal_region(labels);
    if (has_peritoneum && !region.box.is_empty()) derive_peritoneum(labels, region);
    if (has_recess && !region.box.is_empty()) derive_pleural_recess(labels, region);
  }
  if (choice.has("inferior_epigastric_zone") && !labels.is_labelled("inferior_epigastric_zone_left") &&
      !labels.is_labelled("inferior_epigastric_zone_right"))
    derive_epigastric_zone(labels);
}

}  // namespace trocar::anatomy::detail
