#include <algorithm>
#include <cmath>
#include <vector>

#include "anatomy/derive/detail/trunk_parts.h"

namespace trocar::anatomy::detail {
namespace {

// The epigastric vessels lie 4 to 8 cm from the midline at all levels (CT of 100 patients, doi
// 10.1097/01.sla.0000109151.53296.07), behind and in the rectus muscle.
constexpr double kNearMm = 40.0;
constexpr double kFarMm = 80.0;
constexpr double kThicknessMm = 4.0;  // assumed: of the vessels and the sheath
// Assumed levels: from the symphysis, above the lower end of the hip bones, to the umbilicus, above the iliac crests.
constexpr double kSymphysisMm = 40.0;
constexpr double kUmbilicusMm = 20.0;
constexpr double kThinnestMuscleMm = 2.5;
constexpr double kDeepestMm = 80.0;  // the muscle begins within this distance of the skin
constexpr double kSmoothingMm = 9.0;
constexpr double kRectusMm = 25.0;      // from the midline: the rectus is here at every level
constexpr double kFromRectusMm = 25.0;  // a muscle this much farther back or in front is another one

/// Index j of the last voxel of the first muscle from the front in a column; -1: none.
std::int64_t muscle_end(const DerivedLabels& labels, const std::array<bool, 256>& is_muscle, std::int64_t i,
                        std::int64_t k) {
  const volume::GridGeometry& g = labels.geometry();
  const double spacing_mm = g.spacing_mm.y();
  const volume::FloatGrid& skin_mm = labels.patient().skin_distance_mm;
  std::int64_t skin_j = -1, first = -1;
  for (std::int64_t j = 0; j < g.size[1]; ++j) {
    const std::size_t n = g.offset({i, j, k});
    if (skin_j < 0 && skin_mm.voxels[n] < 0.0F) skin_j = j;
    if (skin_j < 0) continue;
    if (first < 0 && static_cast<double>(j - skin_j) * spacing_mm > kDeepestMm) return -1;
    const bool is_here = is_muscle[labels.at(n)];
    if (is_here && first < 0) first = j;
    if (is_here || first < 0) continue;
    if (static_cast<double>(j - first) * spacing_mm >= kThinnestMuscleMm) return j - 1;
    first = -1;
  }
  return -1;
}

/// Median of the found values in a window of a row-major map; -1 if most are not found.
std::int64_t window_median(const std::vector<std::int64_t>& map, std::int64_t columns, std::int64_t rows,
                           std::int64_t column, std::int64_t row, std::int64_t half_c, std::int64_t half_r) {
  std::vector<std::int64_t> values;
  std::size_t all = 0;
  for (std::int64_t r = std::max<std::int64_t>(0, row - half_r); r <= std::min(rows - 1, row + half_r); ++r)
    for (std::int64_t c = std::max<std::int64_t>(0, column - half_c); c <= std::min(columns - 1, column + half_c);
         ++c) {
      ++all;
      const std::int64_t value = map[static_cast<std::size_t>(r * columns + c)];
      if (value >= 0) values.push_back(value);
    }
  if (2 * values.size() < all) return -1;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

class EpigastricZone {
 public:
  explicit EpigastricZone(DerivedLabels& labels) : labels_(labels) {
    for (const Label& label : labels.patient().label_table.labels) is_muscle_[label.id] = label.tissue == "muscle";
  }

  /// Paints one side: columns first_i to last_i, slices first_k to last_k.
  void paint(const char* name, std::int64_t rectus_i, std::int64_t first_i, std::int64_t last_i, std::int64_t first_k,
             std::int64_t last_k) {
    const volume::GridGeometry& g = labels_.geometry();
    first_i = std::max<std::int64_t>(0, first_i);
    last_i = std::min(g.size[0] - 1, last_i);
    const std::int64_t columns = last_i - first_i + 1, rows = last_k - first_k + 1;
    if (columns <= 0 || rows <= 0) return;
    std::vector<std::int64_t> ends(static_cast<std::size_t>(columns * rows));
    const double reach = kFromRectusMm / g.spacing_mm.y();
    for (std::int64_t r = 0; r < rows; ++r) {
      const std::int64_t rectus = rectus_end(rectus_i, first_k + r);
      for (std::int64_t c = 0; c < columns; ++c) {
        const std::int64_t end = muscle_end(labels_, is_muscle_, first_i + c, first_k + r);
        const bool is_rectus = rectus >= 0 && end >= 0 && std::abs(static_cast<double>(end - rectus)) <= reach;
        ends[static_cast<std::size_t>(r * columns + c)] = is_rectus ? end : -1;
      }
    }
    const std::uint8_t id = labels_.add(name);
    const auto half = [&](double spacing_mm) { return std::lround(0.5 * kSmoothingMm / spacing_mm); };
    const auto thickness = std::max<std::int64_t>(1, std::lround(kThicknessMm / g.spacing_mm.y()));
    for (std::int64_t r = 0; r < rows; ++r)
      for (std::int64_t c = 0; c < columns; ++c) {
        const std::int64_t end =
            window_median(ends, columns, rows, c, r, half(g.spacing_mm.x()), half(g.spacing_mm.z()));
        for (std::int64_t j = end; end >= 0 && j > std::max<std::int64_t>(-1, end - thickness); --j)
          labels_.paint(g.offset({first_i + c, j, first_k + r}), id);
      }
  }

 private:
  /// Median of the rectus' posterior surface in five columns; -1: not found.
  std::int64_t rectus_end(std::int64_t i, std::int64_t k) const {
    std::vector<std::int64_t> ends;
    for (std::int64_t column = i - 2; column <= i + 2; ++column)
      if (labels_.geometry().contains({column, 0, k}))
        if (const std::int64_t end = muscle_end(labels_, is_muscle_, column, k); end >= 0) ends.push_back(end);
    if (ends.empty()) return -1;
    std::nth_element(ends.begin(), ends.begin() + static_cast<std::ptrdiff_t>(ends.size() / 2), ends.end());
    return ends[ends.size() / 2];
  }

  DerivedLabels& labels_;
  std::array<bool, 256> is_muscle_{};
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
  const std::int64_t near = steps(kNearMm, g.spacing_mm.x()), far = steps(kFarMm, g.spacing_mm.x());
  const std::int64_t rectus = steps(kRectusMm, g.spacing_mm.x());
  const std::int64_t first_k = hips.low[2] + steps(kSymphysisMm, g.spacing_mm.z());
  const std::int64_t last_k = std::min(g.size[2] - 1, hips.high[2] + steps(kUmbilicusMm, g.spacing_mm.z()));
  const auto centre = static_cast<std::int64_t>(std::lround(middle));
  EpigastricZone zone(labels);
  zone.paint("inferior_epigastric_zone_left", centre + rectus, centre + near, centre + far, first_k, last_k);
  zone.paint("inferior_epigastric_zone_right", centre - rectus, centre - far, centre - near, first_k, last_k);
}

}  // namespace trocar::anatomy::detail
