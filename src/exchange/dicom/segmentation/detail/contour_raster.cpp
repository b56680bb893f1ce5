#include "dicom/segmentation/detail/contour_raster.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/available_memory.h"

namespace trocar::dicom::detail {
namespace {

constexpr double kMaxBend_mm = 0.3;         ///< Distance of points from their plane: files round to 0.01 to 0.1 mm.
constexpr double kContoursParallel = 0.01;  ///< Sine of the angle to an axis of the CT; 0.6 degrees.
constexpr std::int64_t kMostContourPlanes = 1 << 14;
constexpr std::int64_t kMostBeside = 1 << 9;  ///< Pixels beside the grid that are counted, on each side.
constexpr double kEvenPlanes = 0.05;          ///< Of the usual distance.
constexpr const char* kExportStructureAgain = "export the structure set again, or the structure as .seg.nrrd";

/// Twice the area of a contour along its normal (Newell's method); right-handed about the order of the points.
Vec3 area_vector(const Contour& contour) {
  Vec3 sum = Vec3::Zero();
  const Vec3& origin = contour.front();
  for (std::size_t n = 1; n + 1 < contour.size(); ++n) sum += (contour[n] - origin).cross(contour[n + 1] - origin);
  return sum;
}

/// The normal of the largest contour: small ones have none worth mentioning.
Vec3 common_normal(const std::vector<Contour>& contours, const Vec3& fallback) {
  Vec3 largest = Vec3::Zero();
  for (const Contour& contour : contours)
    if (const Vec3 area = area_vector(contour); area.squaredNorm() > largest.squaredNorm()) largest = area;
  return largest.norm() > 1e-6 ? largest.normalized() : fallback;
}

Status check_planar(const ContourStructure& structure, const Vec3& normal, const std::string& where) {
  for (std::size_t n = 0; n < structure.contours.size(); ++n) {
    const Contour& contour = structure.contours[n];
    for (const Vec3& point : contour)
      if (std::abs(normal.dot(point - contour.front())) > 2.0 * kMaxBend_mm)
        return fail(fmt::format("contour {} of \"{}\" is not planar or not parallel to the others", n + 1,
                                structure.segment.name),
                    where, kExportStructureAgain);
  }
  return {};
}

/// Even-odd fill of the pixel centres in a box: every edge turns over all pixels of a row that lie beyond it.
class PlaneFill {
 public:
  /// Columns `first_u` to below `last_u`, rows `first_v` to below `last_v`.
  PlaneFill(std::int64_t first_u, std::int64_t last_u, std::int64_t first_v, std::int64_t last_v)
      : first_u_(first_u),
        first_v_(first_v),
        columns_(last_u - first_u),
        rows_(last_v - first_v),
        turns_(static_cast<std::size_t>((columns_ + 1) * rows_), 0) {}

  void add(const FlatContour& contour) {
    for (std::size_t n = 0; n < contour.points.size(); ++n)
      add_edge(contour.points[n], contour.points[(n + 1) % contour.points.size()]);
  }

  /// The pixels inside at least one of the contours, as one outline.
  void add_union(const std::vector<const FlatContour*>& contours) {
    std::vector<std::uint8_t> inside(static_cast<std::size_t>(columns_ * rows_), 0);
    for (const FlatContour* contour : contours) {
      PlaneFill one(first_u_, first_u_ + columns_, first_v_, first_v_ + rows_);
      one.add(*contour);
      one.for_inside([&](std::int64_t u, std::int64_t v) {
        inside[static_cast<std::size_t>((v - first_v_) * columns_ + u - first_u_)] = 1;
      });
    }
    for (std::int64_t row = 0; row < rows_; ++row) {
      std::uint8_t before = 0;
      for (std::int64_t column = 0; column <= columns_; ++column) {
        const std::uint8_t here = column < columns_ ? inside[static_cast<std::size_t>(row * columns_ + column)] : 0;
        turns_[static_cast<std::size_t>(row * (columns_ + 1) + column)] ^= here ^ before;
        before = here;
      }
    }
  }

  /// Calls set(u, v) for every pixel inside.
  template <class Set>
  void for_inside(const Set& set) const {
    for (std::int64_t row = 0; row < rows_; ++row) {
      std::uint8_t is_inside = 0;
      for (std::int64_t column = 0; column < columns_; ++column) {
        is_inside ^= turns_[static_cast<std::size_t>(row * (columns_ + 1) + column)];
        if (is_inside != 0) set(first_u_ + column, first_v_ + row);
      }
    }
  }

 private:
  /// A row belongs to an edge from its lower end (included) to its upper one (not included).
  void add_edge(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const Eigen::Vector2d& low = a.y() < b.y() ? a : b;
    const Eigen::Vector2d& high = a.y() < b.y() ? b : a;
    const auto first_v = static_cast<double>(first_v_);
    const auto first_u = static_cast<double>(first_u_);
    const double first = std::clamp(std::ceil(low.y()) - first_v, 0.0, static_cast<double>(rows_));
    const double last = std::clamp(std::ceil(high.y()) - first_v, 0.0, static_cast<double>(rows_));
    for (auto row = static_cast<std::int64_t>(first); row < static_cast<std::int64_t>(last); ++row) {
      const double share = (static_cast<double>(row) + first_v - low.y()) / (high.y() - low.y());
      const double column = std::ceil(low.x() + share * (high.x() - low.x())) - first_u;
      const auto at = static_cast<std::int64_t>(std::clamp(column, 0.0, static_cast<double>(columns_)));
      turns_[static_cast<std::size_t>(row * (columns_ + 1) + at)] ^= 1;
    }
  }

  std::int64_t first_u_;
  std::int64_t first_v_;
  std::int64_t columns_;
  std::int64_t rows_;
  std::vector<std::uint8_t> turns_;
};

/// The first whole number from `index` on, near a grid of `count` pixels.
std::int64_t first_pixel(double index, std::int64_t count) {
  return static_cast<std::int64_t>(
      std::clamp(std::ceil(index), static_cast<double>(-kMostBeside), static_cast<double>(count + kMostBeside)));
}

/// Fills one group; returns the number of voxels beyond the grid.
std::uint64_t fill_group(const ContourGroup& group, const ContourGrid& grid, std::vector<std::uint8_t>& mask) {
  const auto u = static_cast<std::size_t>((grid.axis + 1) % 3);
  const auto v = static_cast<std::size_t>((grid.axis + 2) % 3);
  const auto w = static_cast<std::size_t>(grid.axis);
  const auto& size = grid.geometry.size;
  const std::int64_t first = first_pixel(group.low, size[w]), last = first_pixel(group.high, size[w]);
  if (first >= last) return 0;
  PlaneFill fill(first_pixel(group.box.min().x(), size[u]), first_pixel(group.box.max().x() + 1.0, size[u]),
                 first_pixel(group.box.min().y(), size[v]), first_pixel(group.box.max().y() + 1.0, size[v]));
  for (const FlatContour* contour : group.outlines.contours) fill.add(*contour);
  for (const auto& contours : group.outlines.united) fill.add_union(contours);
  const std::int64_t first_inside = std::max<std::int64_t>(first, 0), last_inside = std::min(last, size[w]);
  std::uint64_t outside = 0;
  fill.for_inside([&](std::int64_t column, std::int64_t row) {
    const bool is_beside = column < 0 || row < 0 || column >= size[u] || row >= size[v];
    const std::int64_t planes = is_beside ? 0 : std::max<std::int64_t>(last_inside - first_inside, 0);
    outside += static_cast<std::uint64_t>(last - first - planes);
    volume::Index3 ijk{};
    ijk[u] = column;
    ijk[v] = row;
    for (std::int64_t plane = first_inside; plane < first_inside + planes; ++plane) {
      ijk[w] = plane;
      mask[grid.geometry.offset(ijk)] = 1;
    }
  });
  return outside;
}

/// True if the planes at these places lie on steps of `step_mm`.
bool are_on_steps(const std::vector<double>& places_mm, double step_mm) {
  return std::all_of(places_mm.begin(), places_mm.end(), [&](double place_mm) {
    const double steps = (place_mm - places_mm.front()) / step_mm;
    return std::abs(steps - std::round(steps)) <= kEvenPlanes;
  });
}

/// A grid along contours that are parallel to no plane of the CT, with the CT's finest spacing in their planes, and
/// along them if their distances differ.
volume::GridGeometry grid_along(const ContourStructure& structure, const Vec3& normal, const volume::GridGeometry& ct) {
  volume::GridGeometry g;
  Vec3 u = ct.R_PV.col(0) - normal.dot(ct.R_PV.col(0)) * normal;
  if (u.norm() < 0.5) u = ct.R_PV.col(1) - normal.dot(ct.R_PV.col(1)) * normal;
  u.normalize();
  g.R_PV << u, normal.cross(u), normal;
  g.spacing_mm.setConstant(ct.spacing_mm.minCoeff());
  Vec3 low = Vec3::Constant(HUGE_VAL);
  Vec3 high = Vec3::Constant(-HUGE_VAL);
  std::vector<double> along_mm;
  for (const Contour& contour : structure.contours) {
    along_mm.push_back(normal.dot(contour.front()));
    for (const Vec3& point : contour) {
      low = low.cwiseMin(g.R_PV.transpose() * point);
      high = high.cwiseMax(g.R_PV.transpose() * point);
    }
  }
  const double usual_mm = usual_distance(along_mm, g.spacing_mm.z());
  if (are_on_steps(along_mm, usual_mm)) {
    g.spacing_mm.z() = usual_mm;
  } else {
    // The outermost planes reach half a usual distance.
    low.z() -= 0.5 * usual_mm;
    high.z() += 0.5 * usual_mm;
  }
  const Vec3 extent = (high - low).cwiseQuotient(g.spacing_mm);
  for (int axis = 0; axis < 3; ++axis)
    g.size[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(
        std::clamp(std::ceil(extent[axis] - 0.01), 0.0, static_cast<double>(kMostContourPlanes)) + 1.0);
  g.origin_P = g.R_PV * low;
  return g;
}

}  // namespace

Result<ContourGrid> choose_grid(const ContourStructure& structure, const volume::GridGeometry& ct,
                                const std::string& where) {
  const Vec3 normal = common_normal(structure.contours, ct.R_PV.col(2));
  for (int axis = 0; axis < 3; ++axis) {
    if (ct.R_PV.col(axis).cross(normal).norm() > kContoursParallel) continue;
    TROCAR_TRY_STATUS(check_planar(structure, ct.R_PV.col(axis), where));
    return ContourGrid{ct, axis};
  }
  TROCAR_TRY_STATUS(check_planar(structure, normal, where));
  const ContourGrid grid{grid_along(structure, normal, ct), 2};
  TROCAR_TRY_STATUS(check_memory_for_image(grid.geometry.voxel_count(), available_memory_bytes(), where));
  return grid;
}

RasterResult rasterise(const ContourStructure& structure, const ContourGrid& grid) {
  RasterResult result;
  result.mask.assign(grid.geometry.voxel_count(), 0);
  if (structure.contours.empty()) return result;
  const std::vector<FlatContour> flat = flatten(structure.contours, grid);
  const GroupedContours grouped = group_contours(flat, grid, structure.is_exclusive_or);
  result.distances = grouped.distances;
  std::uint64_t outside = 0;
  for (const ContourGroup& group : grouped.groups) {
    outside += fill_group(group, grid, result.mask);
    const double ml_per_mm2 = (group.high - group.low) * grid.geometry.spacing_mm[grid.axis] / 1000.0;
    result.repeated += group.outlines.repeated;
    result.crossing += group.outlines.crossing;
    result.crossing_ml += group.outlines.crossing_mm2 * ml_per_mm2;
    result.doubtful += group.outlines.doubtful;
    result.doubtful_ml += group.outlines.doubtful_mm2 * ml_per_mm2;
  }
  result.outside_ml = static_cast<double>(outside) * grid.geometry.voxel_volume_mm3() / 1000.0;
  return result;
}

}  // namespace trocar::dicom::detail
