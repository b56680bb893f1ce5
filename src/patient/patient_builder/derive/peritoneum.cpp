#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "anatomy/known_structures.h"
#include "core/parallel.h"
#include "patient_builder/derive/detail/derived_labels.h"
#include "volume/distance.h"
#include "volume/morphology.h"
#include "volume/resample.h"
#include "volume/sampling.h"

namespace trocar::patient_builder::detail {
namespace {

constexpr double kRegionVoxelMm = 4.0;
constexpr double kAccuracyMm = 1.0;     // of the region's surface
constexpr double kNarrowMm = 16.0;      // assumed: spaces between organs up to twice this belong to the cavity
constexpr double kMembraneMm = 1.2;     // membrane and the tissue that holds it: data/phantoms/layers.toml, liver
constexpr double kDeepInsideMm = -5.0;  // assumed: lean tissue this far inside the region is no wall

/// Organs with the tissue of those in the peritoneal cavity, but outside it.
bool is_outside(std::string_view name) {
  const std::string plain = anatomy::without_side(anatomy::plain_name(name));
  for (const char* other : {"duodenum", "esophagus", "oesophagus", "rectum"})
    if (plain == other) return true;
  return false;
}

bool is_in_cavity(const anatomy::Label& label) {
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
  for (const anatomy::Label& label : labels.patient().label_table.labels) {
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
  for (const anatomy::Label& label : labels.patient().label_table.labels)
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

bool is_portal(const anatomy::Label& label) {
  return label.tissue == "vessel" && anatomy::plain_name(label.name).starts_with("portalvein");
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
  for (const anatomy::Label& label : labels.patient().label_table.labels) {
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

}  // namespace trocar::patient_builder::detail
