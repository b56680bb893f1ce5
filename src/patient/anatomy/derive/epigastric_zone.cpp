#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "anatomy/derive/detail/trunk_parts.h"

namespace trocar::anatomy::detail {
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
    for (const Label& label : labels.patient().label_table.labels) {
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
  const LabelTable& table = labels.patient().label_table;
  const Label *hip_left = table.find("hip_left"), *hip_right = table.find("hip_right");
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

}  // namespace trocar::anatomy::detail
