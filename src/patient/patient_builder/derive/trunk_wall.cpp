#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/parallel.h"
#include "patient_builder/derive/detail/derived_labels.h"
#include "volume/distance.h"
#include "volume/morphology.h"
#include "volume/resample.h"
#include "volume/sampling.h"

namespace trocar::patient_builder::detail {
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
  for (const anatomy::Label& label : labels.patient().label_table.labels)
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

Vec3 trunk_axis(const anatomy::VirtualPatient& patient) {
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

namespace {

// The epigastric vessels lie 4 to 8 cm from the midline at all levels (CT of 100 patients, doi
// 10.1097/01.sla.0000109151.53296.07), behind and in the rectus muscle.
constexpr double kNearMidlineMm = 40.0;
constexpr double kFarFromMidlineMm = 80.0;
constexpr double kThicknessMm = 4.0;  // assumed: of the vessels and the sheath
// Assumed levels: from the symphysis, above the lower end of the hip bones, to the umbilicus, above the iliac crests.
constexpr double kSymphysisMm = 40.0;
constexpr double kUmbilicusMm = 20.0;
constexpr double kThinnestMuscleMm = 2.5;
constexpr double kDeepestMuscleMm = 80.0;  // the muscle begins within this distance of the skin
constexpr double kSmoothingMm = 9.0;
constexpr double kDeeperMm = 25.0;    // a muscle this much deeper below the skin than the rectus is another one
constexpr double kLeastFound = 0.25;  // share of a slice's columns in which the muscle must be found

/// A column from the front: its first voxel below the skin, and the depth of the muscle's last voxel below that one.
struct Column {
  std::int64_t skin_j = -1;
  std::int64_t depth = -1;  ///< -1: no muscle was found.
};

/// Looks for the first muscle from the front.
Column find_muscle(const DerivedLabels& labels, const std::array<bool, 256>& is_muscle,
                   const std::array<bool, 256>& is_membrane, std::int64_t i, std::int64_t k) {
  const volume::GridGeometry& g = labels.geometry();
  const double spacing_mm = g.spacing_mm.y();
  const volume::FloatGrid& skin_mm = labels.patient().skin_distance_mm;
  Column column;
  std::int64_t first = -1;
  for (std::int64_t j = 0; j < g.size[1]; ++j) {
    const std::size_t n = g.offset({i, j, k});
    if (column.skin_j < 0 && skin_mm.voxels[n] < 0.0F) column.skin_j = j;
    if (column.skin_j < 0) continue;
    if (first < 0 && static_cast<double>(j - column.skin_j) * spacing_mm > kDeepestMuscleMm) return column;
    const std::uint8_t id = labels.at(n);
    if (is_muscle[id] && first < 0) first = j;
    if (is_muscle[id] || first < 0) continue;
    // A thin muscle can be followed by the peritoneum that was made of its last voxels.
    if (is_membrane[id] || static_cast<double>(j - first) * spacing_mm >= kThinnestMuscleMm) {
      column.depth = j - 1 - column.skin_j;
      return column;
    }
    first = -1;
  }
  return column;
}

/// The value at a share of sorted values, 0 the least, 0.5 the median. Precondition: not empty.
std::int64_t quantile(std::vector<std::int64_t> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

class EpigastricZone {
 public:
  explicit EpigastricZone(DerivedLabels& labels) : labels_(labels) {
    for (const anatomy::Label& label : labels.patient().label_table.labels) {
      is_muscle_[label.id] = label.tissue == "muscle";
      is_membrane_[label.id] = label.tissue == "peritoneum";
    }
  }

  /// Paints one side: columns first_i to last_i, slices first_k to last_k.
  void paint(const char* name, std::int64_t first_i, std::int64_t last_i, std::int64_t first_k, std::int64_t last_k) {
    const volume::GridGeometry& g = labels_.geometry();
    first_i_ = std::max<std::int64_t>(0, first_i);
    columns_ = std::min(g.size[0] - 1, last_i) - first_i_ + 1;
    rows_ = last_k - first_k + 1;
    if (columns_ <= 0 || rows_ <= 0) return;
    map_.clear();
    for (std::int64_t r = 0; r < rows_; ++r) add_slice(first_k + r);
    const std::uint8_t id = labels_.add(name);
    const auto thickness = std::max<std::int64_t>(1, std::lround(kThicknessMm / g.spacing_mm.y()));
    for (std::int64_t r = 0; r < rows_; ++r)
      for (std::int64_t c = 0; c < columns_; ++c) {
        const std::int64_t depth = smooth_depth(c, r);
        const std::int64_t skin_j = at(c, r).skin_j;
        if (depth < 0 || skin_j < 0) continue;
        for (std::int64_t j = skin_j + depth; j > std::max<std::int64_t>(-1, skin_j + depth - thickness); --j)
          if (g.contains({first_i_ + c, j, first_k + r})) labels_.paint(g.offset({first_i_ + c, j, first_k + r}), id);
      }
  }

 private:
  const Column& at(std::int64_t c, std::int64_t r) const { return map_[static_cast<std::size_t>(r * columns_ + c)]; }

  /// Adds the columns of a slice. The rectus is the shallow muscle; where it is not found, it continues at its median
  /// depth, because the vessels do. No depth at all if it is found nearly nowhere.
  void add_slice(std::int64_t k) {
    std::vector<Column> slice;
    for (std::int64_t c = 0; c < columns_; ++c)
      slice.push_back(find_muscle(labels_, is_muscle_, is_membrane_, first_i_ + c, k));
    std::vector<std::int64_t> depths = found_depths(slice);
    if (!depths.empty()) {
      const auto deepest = quantile(depths, 0.25) + std::lround(kDeeperMm / labels_.geometry().spacing_mm.y());
      for (Column& column : slice)
        if (column.depth > deepest) column.depth = -1;
      depths = found_depths(slice);
    }
    const bool is_enough = static_cast<double>(depths.size()) >= kLeastFound * static_cast<double>(slice.size());
    for (Column& column : slice)
      if (column.depth < 0 || !is_enough) column.depth = is_enough ? quantile(depths, 0.5) : -1;
    map_.insert(map_.end(), slice.begin(), slice.end());
  }

  static std::vector<std::int64_t> found_depths(const std::vector<Column>& columns) {
    std::vector<std::int64_t> depths;
    for (const Column& column : columns)
      if (column.depth >= 0) depths.push_back(column.depth);
    return depths;
  }

  /// Median depth of the neighbourhood; -1 if there is none.
  std::int64_t smooth_depth(std::int64_t column, std::int64_t row) const {
    const Vec3& spacing = labels_.geometry().spacing_mm;
    const std::int64_t half_c = std::lround(0.5 * kSmoothingMm / spacing.x());
    const std::int64_t half_r = std::lround(0.5 * kSmoothingMm / spacing.z());
    if (at(column, row).depth < 0) return -1;
    std::vector<std::int64_t> depths;
    for (std::int64_t r = std::max<std::int64_t>(0, row - half_r); r <= std::min(rows_ - 1, row + half_r); ++r)
      for (std::int64_t c = std::max<std::int64_t>(0, column - half_c); c <= std::min(columns_ - 1, column + half_c);
           ++c)
        if (at(c, r).depth >= 0) depths.push_back(at(c, r).depth);
    return quantile(std::move(depths), 0.5);
  }

  DerivedLabels& labels_;
  std::array<bool, 256> is_muscle_{}, is_membrane_{};
  std::int64_t first_i_ = 0, columns_ = 0, rows_ = 0;
  std::vector<Column> map_;  ///< By slice and column.
};

}  // namespace

void derive_epigastric_zone(DerivedLabels& labels) {
  const anatomy::LabelTable& table = labels.patient().label_table;
  const anatomy::Label *hip_left = table.find("hip_left"), *hip_right = table.find("hip_right");
  if (hip_left == nullptr || hip_right == nullptr) return;
  IndexBox hips = labels.boxes().box[hip_left->id];
  hips.include(labels.boxes().box[hip_right->id]);
  if (hips.is_empty()) return;
  const volume::GridGeometry& g = labels.geometry();
  const auto steps = [](double mm, double spacing_mm) {
    return static_cast<std::int64_t>(std::lround(mm / spacing_mm));
  };
  const double middle = 0.5 * static_cast<double>(hips.low[0] + hips.high[0]);
  const std::int64_t near = steps(kNearMidlineMm, g.spacing_mm.x()), far = steps(kFarFromMidlineMm, g.spacing_mm.x());
  const std::int64_t first_k = hips.low[2] + steps(kSymphysisMm, g.spacing_mm.z());
  const std::int64_t last_k = std::min(g.size[2] - 1, hips.high[2] + steps(kUmbilicusMm, g.spacing_mm.z()));
  const auto centre = static_cast<std::int64_t>(std::lround(middle));
  EpigastricZone zone(labels);
  zone.paint("inferior_epigastric_zone_left", centre + near, centre + far, first_k, last_k);
  zone.paint("inferior_epigastric_zone_right", centre - far, centre - near, first_k, last_k);
}

}  // namespace trocar::patient_builder::detail
