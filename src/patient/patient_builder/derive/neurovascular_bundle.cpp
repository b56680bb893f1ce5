#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "anatomy/known_structures.h"
#include "patient_builder/derive/detail/derived_labels.h"

namespace trocar::patient_builder::detail {
namespace {

// Vein, artery and nerve in the costal groove, at the lower border of the rib, inner side: a tube along the border
// (docs/physics.md, N1).
constexpr double kBundleRadiusMm = 2.0;  // assumed: the three vessels and nerves beside each other are about 4 mm high
constexpr int kRibSectors = 120;
constexpr double kLongestGapMm = 25.0;  // between two points of a rib: a fault of the segmentation, not its end
// A thinner tube would be cut where it passes between the middles of voxels: four of them are 0.71 voxels away.
constexpr double kFillVoxels = 0.75;

/// Sector of a direction around the axis of the trunk.
std::size_t sector_of(const Vec3& p_P, const Vec3& axis_P) {
  const double angle = std::atan2(p_P.y() - axis_P.y(), p_P.x() - axis_P.x());
  const double share = (angle + std::numbers::pi) / (2.0 * std::numbers::pi);
  return static_cast<std::size_t>(std::clamp(static_cast<int>(share * kRibSectors), 0, kRibSectors - 1));
}

/// "rib_left_7"; not "ribs", a label of all of them.
bool is_single_rib(const anatomy::Label& label) {
  const std::string plain = anatomy::without_side(anatomy::plain_name(label.name));
  return label.tissue == "bone" && plain.starts_with("rib") && plain.size() > 3 && plain != "ribs";
}

/// The lowest voxel of a column of a rib.
struct RibBottom {
  Vec3 p_P = Vec3::Zero();
  float skin_distance_mm = 0.0F;
};
using BottomsBySector = std::array<std::vector<RibBottom>, kRibSectors>;

BottomsBySector rib_bottoms(const DerivedLabels& labels, std::uint8_t id, const Vec3& axis_P) {
  const volume::GridGeometry& g = labels.geometry();
  const IndexBox& box = labels.boxes().box[id];
  BottomsBySector bottoms;
  for (std::int64_t j = box.low[1]; j <= box.high[1]; ++j)
    for (std::int64_t i = box.low[0]; i <= box.high[0]; ++i)
      for (std::int64_t k = box.low[2]; k <= box.high[2]; ++k) {
        const std::size_t n = g.offset({i, j, k});
        if (labels.at(n) != id) continue;
        const Vec3 p_P = g.centre_mm({i, j, k});
        bottoms[sector_of(p_P, axis_P)].push_back({p_P, labels.patient().skin_distance_mm.voxels[n]});
        break;
      }
  return bottoms;
}

/// The middle of the bundle in a sector: below the inner half of the rib. Empty without a rib.
std::optional<Vec3> bundle_point(std::vector<RibBottom> bottoms, double voxel_mm) {
  if (bottoms.empty()) return std::nullopt;
  const auto middle = bottoms.begin() + static_cast<std::ptrdiff_t>(bottoms.size() / 2);
  std::nth_element(bottoms.begin(), middle, bottoms.end(),
                   [](const RibBottom& a, const RibBottom& b) { return a.skin_distance_mm < b.skin_distance_mm; });
  const float innermost_mm = middle->skin_distance_mm;
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  for (const RibBottom& bottom : bottoms) {
    if (bottom.skin_distance_mm > innermost_mm) continue;
    sum += bottom.p_P;
    count += 1.0;
  }
  return sum / count - (0.5 * voxel_mm + kBundleRadiusMm) * Vec3::UnitZ();
}

/// The points of a rib in the order of its course, which begins behind the widest gap around the trunk.
std::vector<Vec3> course_of(const BottomsBySector& bottoms, double voxel_mm) {
  std::size_t start = 0, empty = 0, most = 0;
  for (std::size_t n = 0; n < 2 * bottoms.size(); ++n) {
    const std::size_t sector = n % bottoms.size();
    empty = bottoms[sector].empty() ? empty + 1 : 0;
    if (empty <= most || empty > bottoms.size()) continue;
    most = empty;
    start = sector + 1;
  }
  std::vector<Vec3> points;
  for (std::size_t n = 0; n < bottoms.size(); ++n)
    if (const auto point = bundle_point(bottoms[(start + n) % bottoms.size()], voxel_mm)) points.push_back(*point);
  std::vector<Vec3> smooth = points;  // the steps of thick slices
  for (std::size_t n = 1; n + 1 < points.size(); ++n)
    smooth[n].z() = 0.25 * points[n - 1].z() + 0.5 * points[n].z() + 0.25 * points[n + 1].z();
  return smooth;
}

/// Paints a tube between two points: voxels whose middle is inside, at least one voxel thick in each direction of the
/// grid. Where bone or cartilage is in the way, the voxel below takes its place.
class TubePainter {
 public:
  TubePainter(DerivedLabels& labels, std::uint8_t id) : labels_(labels), id_(id) {
    const Vec3& spacing_mm = labels.geometry().spacing_mm;
    for (int axis = 0; axis < 3; ++axis)
      radius_voxels_[axis] = std::max(kBundleRadiusMm / spacing_mm[axis], kFillVoxels);
  }

  void paint(const Vec3& a_P, const Vec3& b_P) {
    const volume::GridGeometry& g = labels_.geometry();
    const Vec3 a = g.to_index(a_P).cwiseQuotient(radius_voxels_), b = g.to_index(b_P).cwiseQuotient(radius_voxels_);
    IndexBox box;
    for (const Vec3& end_P : {a_P, b_P}) {
      const Vec3 index = g.to_index(end_P);
      box.include(volume::Index3{std::lround(index.x()), std::lround(index.y()), std::lround(index.z())});
    }
    const double reach_mm = radius_voxels_.cwiseProduct(g.spacing_mm).maxCoeff() + g.spacing_mm.maxCoeff();
    const Vec3 way = b - a;
    for_each_in(g, grown(box, reach_mm, g), [&](std::size_t, std::size_t, const volume::Index3& ijk) {
      const Vec3 p = volume::to_vec3(ijk).cwiseQuotient(radius_voxels_);
      const double f = std::clamp((p - a).dot(way) / std::max(way.squaredNorm(), 1e-9), 0.0, 1.0);
      if ((p - a - f * way).norm() <= 1.0) paint_or_below(ijk);
    });
  }

 private:
  void paint_or_below(volume::Index3 ijk) {
    const volume::GridGeometry& g = labels_.geometry();
    constexpr int kMostBelow = 2;
    for (int step = 0; step <= kMostBelow && ijk[2] >= 0; ++step, --ijk[2]) {
      const std::size_t n = g.offset(ijk);
      const std::uint8_t here = labels_.at(n);
      if (!labels_.has_tissue(here, "bone") && !labels_.has_tissue(here, "cartilage")) return labels_.paint(n, id_);
    }
  }

  DerivedLabels& labels_;
  std::uint8_t id_;
  Vec3 radius_voxels_ = Vec3::Ones();
};

/// Joins voxels of the bundle that have only an edge or a corner in common, where soft tissue between them permits.
class CornerFiller {
 public:
  CornerFiller(DerivedLabels& labels, std::uint8_t id) : labels_(labels), id_(id) {}

  void fill(const IndexBox& box) {
    for_each_in(labels_.geometry(), box, [&](std::size_t n, std::size_t, const volume::Index3& ijk) {
      if (labels_.at(n) != id_) return;
      for (std::int64_t code = 14; code < 27; ++code)  // the half of the 26 neighbours that comes later
        join(ijk, {code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1});
    });
  }

 private:
  void join(const volume::Index3& from, const volume::Index3& step) {
    std::vector<std::size_t> axes;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (step[axis] != 0) axes.push_back(axis);
    const volume::Index3 to{from[0] + step[0], from[1] + step[1], from[2] + step[2]};
    if (axes.size() < 2 || !is(to, false)) return;
    std::vector<volume::Index3> way;
    do {
      std::vector<volume::Index3> between = cells_between(from, step, axes);
      if (std::ranges::all_of(between, [&](const volume::Index3& cell) { return is(cell, false); })) return;
      const bool is_free = std::ranges::all_of(between, [&](const volume::Index3& cell) { return is(cell, true); });
      if (way.empty() && is_free) way = std::move(between);
    } while (std::ranges::next_permutation(axes).found);
    for (const volume::Index3& cell : way) labels_.paint(labels_.geometry().offset(cell), id_);
  }

  /// The cells on the way that takes the axes in this order, without its ends.
  static std::vector<volume::Index3> cells_between(volume::Index3 cell, const volume::Index3& step,
                                                   const std::vector<std::size_t>& axes) {
    std::vector<volume::Index3> cells;
    for (std::size_t n = 0; n + 1 < axes.size(); ++n) {
      cell[axes[n]] += step[axes[n]];
      cells.push_back(cell);
    }
    return cells;
  }

  /// A voxel of the bundle, or one that may become one.
  bool is(const volume::Index3& cell, bool or_soft) const {
    if (!labels_.geometry().contains(cell)) return false;
    const std::uint8_t here = labels_.at(labels_.geometry().offset(cell));
    return here == id_ || (or_soft && labels_.is_soft(here));
  }

  DerivedLabels& labels_;
  std::uint8_t id_;
};

}  // namespace

void derive_neurovascular_bundle(DerivedLabels& labels) {
  std::vector<std::uint8_t> ribs;
  for (const anatomy::Label& label : labels.patient().label_table.labels)
    if (is_single_rib(label)) ribs.push_back(label.id);
  if (ribs.empty()) return;
  const std::uint8_t bundle = labels.add("neurovascular_bundle");
  const Vec3 axis_P = trunk_axis(labels.patient());
  TubePainter painter(labels, bundle);
  CornerFiller filler(labels, bundle);
  for (const std::uint8_t rib : ribs) {
    const std::vector<Vec3> course = course_of(rib_bottoms(labels, rib, axis_P), labels.geometry().spacing_mm.z());
    for (std::size_t n = 0; n < course.size(); ++n) {
      const Vec3& next = course[std::min(n + 1, course.size() - 1)];
      painter.paint(course[n], (next - course[n]).norm() <= kLongestGapMm ? next : course[n]);
    }
    filler.fill(grown(labels.boxes().box[rib], 2.0 * kBundleRadiusMm + 2.0 * labels.geometry().spacing_mm.maxCoeff(),
                      labels.geometry()));
  }
}

}  // namespace trocar::patient_builder::detail
