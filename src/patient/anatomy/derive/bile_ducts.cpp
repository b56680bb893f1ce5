#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "anatomy/derive/detail/trunk_parts.h"
#include "anatomy/structure_pattern.h"
#include "volume/distance.h"

namespace trocar::anatomy::detail {
namespace {

// A normal duct inside the liver has at most 40 % of the diameter of the portal branch beside it, about 1.8 mm in the
// periphery and 2.0 mm centrally (reference values: doi 10.3390/diagnostics15070919).
constexpr double kShareOfVein = 0.4;
constexpr double kThinnestMm = 0.9;  // radius
constexpr double kWidestMm = 2.0;
constexpr double kThinnestVeinMm = 1.5;  // radius: beside thinner branches a duct of 1.8 mm would be too wide
constexpr double kAxisMm = 8.0;          // of the branch that gives its direction
constexpr double kWallMm = 0.5;          // between vein and duct
constexpr double kLongestPieceMm = 5.0;  // longest piece of a duct between two points of its vein
constexpr double kThinnestVoxels = 0.4;  // radius: thinner ducts would be wider in voxels than they are

constexpr float kEqualMm = 0.05F;

/// A point of a vessel's centre line with its radius.
struct Middle {
  Vec3 p_P;
  double radius_mm = 0.0;
};

bool is_portal(const Label& label) {
  return label.tissue == "vessel" && plain_name(label.name).starts_with("portalvein");
}

/// Voxels on the ridge of the distance to the vessel's surface: its centre line.
std::vector<Middle> middle_points(const volume::MaskGrid& vein) {
  const volume::FloatGrid distance_mm = volume::signed_distance_mm(vein);
  const volume::GridGeometry& g = vein.geometry;
  std::vector<Middle> points;
  for (std::size_t n = 0; n < vein.voxels.size(); ++n) {
    const float here = distance_mm.voxels[n];
    if (!vein.voxels[n] || -here < kThinnestVeinMm) continue;
    const volume::Index3 ijk = g.index_of(n);
    // Across a vessel the distance falls to both sides, in at least two of the grid's directions.
    std::size_t falling = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      volume::Index3 low = ijk, high = ijk;
      --low[a];
      ++high[a];
      if (!g.contains(low) || !g.contains(high)) continue;
      const float below = distance_mm[low], above = distance_mm[high];
      // Along the vessel the distance is nearly constant.
      if (std::min(below, above) >= here - kEqualMm && std::max(below, above) > here + kEqualMm) ++falling;
    }
    if (falling >= 2) points.push_back({g.centre_mm(ijk), static_cast<double>(-here)});
  }
  return points;
}

/// Without the points whose ball lies in that of a thicker point: ridges at the steps of the voxels.
std::vector<Middle> without_covered(const std::vector<Middle>& points, double voxel_mm) {
  constexpr double kThickerMm = 0.5;
  std::vector<Middle> kept;
  for (const Middle& point : points) {
    const bool is_covered = std::any_of(points.begin(), points.end(), [&](const Middle& other) {
      return other.radius_mm > point.radius_mm + kThickerMm &&
             (other.p_P - point.p_P).norm() + point.radius_mm <= other.radius_mm + voxel_mm;
    });
    if (!is_covered) kept.push_back(point);
  }
  return kept;
}

/// Direction of the vessel at a point; empty if too few points are near.
std::optional<Vec3> axis_at(const std::vector<Middle>& points, const Vec3& p_P) {
  Mat3 spread = Mat3::Zero();
  int count = 0;
  for (const Middle& other : points) {
    const Vec3 d = other.p_P - p_P;
    if (d.norm() > kAxisMm) continue;
    spread += d * d.transpose();
    ++count;
  }
  if (count < 4) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(spread);
  return Vec3(solver.eigenvectors().col(2));
}

/// The duct beside a point of the vein; empty where the vein runs towards the front.
std::optional<Middle> duct_beside(const std::vector<Middle>& points, const Middle& vein) {
  const std::optional<Vec3> axis = axis_at(points, vein.p_P);
  if (!axis) return std::nullopt;
  const Vec3 front_P = -Vec3::UnitY();  // ducts lie in front of the portal vein's branches
  const Vec3 across_P = front_P - *axis * axis->dot(front_P);
  if (across_P.norm() < 0.2) return std::nullopt;
  const double radius_mm = std::clamp(kShareOfVein * vein.radius_mm, kThinnestMm, kWidestMm);
  return Middle{vein.p_P + across_P.normalized() * (vein.radius_mm + kWallMm + radius_mm), radius_mm};
}

/// Paints the tube between two points where the liver is.
void paint_tube(DerivedLabels& labels, const Middle& a, const Middle& b, std::uint8_t id) {
  const volume::GridGeometry& g = labels.geometry();
  IndexBox box;
  for (const Middle* end : {&a, &b}) {
    const Vec3 index = g.to_index(end->p_P);
    box.include(volume::Index3{std::lround(index.x()), std::lround(index.y()), std::lround(index.z())});
  }
  const double radius_mm = std::max(a.radius_mm, b.radius_mm);
  const Vec3 way_P = b.p_P - a.p_P;
  for_each_in(g, grown(box, radius_mm, g), [&](std::size_t n, std::size_t, const volume::Index3& ijk) {
    const Vec3 p_P = g.centre_mm(ijk);
    const double f = std::clamp((p_P - a.p_P).dot(way_P) / std::max(way_P.squaredNorm(), 1e-9), 0.0, 1.0);
    const double limit_mm = a.radius_mm + f * (b.radius_mm - a.radius_mm);
    if ((p_P - a.p_P - f * way_P).norm() <= limit_mm && labels.has_tissue(labels.at(n), "liver")) labels.replace(n, id);
  });
}

}  // namespace

void derive_bile_ducts(DerivedLabels& labels, const DeriveChoice& choice) {
  if (!choice.has("bile_ducts")) return;
  std::array<bool, 256> is_vein{};
  IndexBox veins, liver;
  for (const Label& label : labels.patient().label_table.labels) {
    if (label.tissue == "bile_duct") return;  // the segmentation has them
    const IndexBox& box = labels.boxes().box[label.id];
    if (label.tissue == "liver") liver.include(box);
    is_vein[label.id] = is_portal(label);
    if (is_vein[label.id]) veins.include(box);
  }
  if (veins.is_empty() || liver.is_empty()) return;
  const IndexBox box = grown(veins, kThinnestVeinMm, labels.geometry());
  const std::vector<Middle> points = without_covered(
      middle_points(cut_mask(labels.patient().labels, box, [&](std::uint8_t id) { return is_vein[id]; })),
      labels.geometry().spacing_mm.maxCoeff());
  const std::uint8_t ducts = labels.add("bile_ducts");
  std::vector<std::pair<Vec3, Middle>> pieces;  // point of the vein, duct beside it
  for (const Middle& point : points) {
    const std::optional<Middle> duct = duct_beside(points, point);
    const bool is_shown = duct && duct->radius_mm >= kThinnestVoxels * labels.geometry().spacing_mm.maxCoeff();
    if (is_shown) pieces.emplace_back(point.p_P, *duct);
  }
  for (std::size_t n = 0; n < pieces.size(); ++n)
    for (std::size_t m = n; m < pieces.size(); ++m) {
      const bool are_next = (pieces[n].first - pieces[m].first).norm() <= kLongestPieceMm &&
                            (pieces[n].second.p_P - pieces[m].second.p_P).norm() <= kLongestPieceMm;
      if (are_next) paint_tube(labels, pieces[n].second, pieces[m].second, ducts);
    }
}

}  // namespace trocar::anatomy::detail
