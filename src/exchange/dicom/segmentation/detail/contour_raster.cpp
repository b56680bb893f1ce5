#include "dicom/segmentation/detail/contour_raster.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/available_memory.h"

namespace trocar::dicom::detail {
namespace {

constexpr double kMaxBend_mm = 0.3;         ///< Distance of points from their plane: files round to 0.01 to 0.1 mm.
constexpr double kContoursParallel = 0.01;  ///< Sine of the angle to an axis of the CT; 0.6 degrees.
constexpr double kContoursOfOnePlane_mm = 0.05;  ///< Contours of one plane.
constexpr double kClosedGap = 2.1;               ///< Gaps up to this multiple of the smallest distance are closed.
constexpr std::int64_t kMostContourPlanes = 1 << 14;
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

/// A contour in indices of a grid: u and v in the plane, w along the axis.
struct FlatContour {
  std::vector<Eigen::Vector2d> points;
  double w = 0.0;
};

/// Contours of one plane.
struct ContourPlane {
  double w = 0.0;
  std::vector<const FlatContour*> contours;
  double low = 0.0;   ///< The plane reaches from here
  double high = 0.0;  ///< to here.
};

std::vector<FlatContour> flatten(const std::vector<Contour>& contours, const ContourGrid& grid) {
  const int u = (grid.axis + 1) % 3;
  const int v = (grid.axis + 2) % 3;
  std::vector<FlatContour> flat;
  for (const Contour& contour : contours) {
    FlatContour& out = flat.emplace_back();
    double sum = 0.0;
    for (const Vec3& point_P : contour) {
      const Vec3 index = grid.geometry.to_index(point_P);
      out.points.emplace_back(index[u], index[v]);
      sum += index[grid.axis];
    }
    out.w = sum / static_cast<double>(contour.size());
  }
  return flat;
}

bool is_repeated(const FlatContour& contour, const std::vector<const FlatContour*>& others) {
  return std::any_of(others.begin(), others.end(),
                     [&](const FlatContour* other) { return contour.points == other->points; });
}

std::vector<ContourPlane> group_planes(const std::vector<FlatContour>& flat, double step_mm, std::size_t& repeated) {
  std::vector<const FlatContour*> ordered;
  for (const FlatContour& contour : flat) ordered.push_back(&contour);
  std::stable_sort(ordered.begin(), ordered.end(), [](const auto* a, const auto* b) { return a->w < b->w; });
  std::vector<ContourPlane> planes;
  for (const FlatContour* contour : ordered) {
    if (planes.empty() || contour->w - planes.back().w > kContoursOfOnePlane_mm / step_mm)
      planes.push_back({contour->w, {}, 0.0, 0.0});
    if (is_repeated(*contour, planes.back().contours))
      ++repeated;
    else
      planes.back().contours.push_back(contour);
  }
  return planes;
}

/// Each plane reaches half-way to its neighbours; at the ends and over wide gaps half the smallest distance.
void set_reach(std::vector<ContourPlane>& planes, RasterResult& result) {
  double smallest = HUGE_VAL;
  for (std::size_t n = 1; n < planes.size(); ++n) smallest = std::min(smallest, planes[n].w - planes[n - 1].w);
  if (planes.size() == 1) smallest = 1.0;  // the step of the grid
  for (std::size_t n = 0; n < planes.size(); ++n) {
    planes[n].low = planes[n].w - 0.5 * smallest;
    planes[n].high = planes[n].w + 0.5 * smallest;
  }
  for (std::size_t n = 1; n < planes.size(); ++n) {
    const double gap = planes[n].w - planes[n - 1].w;
    if (gap > kClosedGap * smallest) {
      ++result.open_gaps;
      continue;
    }
    if (gap > 1.5 * smallest) ++result.filled_gaps;
    planes[n - 1].high = planes[n].low = 0.5 * (planes[n].w + planes[n - 1].w);
  }
}

/// Even-odd fill of pixel centres: every edge turns over all pixels of a row that lie beyond it.
class PlaneFill {
 public:
  PlaneFill(std::int64_t columns, std::int64_t rows)
      : columns_(columns), rows_(rows), turns_(static_cast<std::size_t>((columns + 1) * rows), 0) {}

  void add(const FlatContour& contour) {
    for (std::size_t n = 0; n < contour.points.size(); ++n)
      add_edge(contour.points[n], contour.points[(n + 1) % contour.points.size()]);
  }

  /// Calls set(column, row) for every pixel inside.
  template <class Set>
  void for_inside(const Set& set) const {
    for (std::int64_t row = 0; row < rows_; ++row) {
      std::uint8_t is_inside = 0;
      for (std::int64_t column = 0; column < columns_; ++column) {
        is_inside ^= turns_[static_cast<std::size_t>(row * (columns_ + 1) + column)];
        if (is_inside != 0) set(column, row);
      }
    }
  }

 private:
  /// A row belongs to an edge from its lower end (included) to its upper one (not included).
  void add_edge(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const Eigen::Vector2d& low = a.y() < b.y() ? a : b;
    const Eigen::Vector2d& high = a.y() < b.y() ? b : a;
    const double first = std::clamp(std::ceil(low.y()), 0.0, static_cast<double>(rows_));
    const double last = std::clamp(std::ceil(high.y()), 0.0, static_cast<double>(rows_));
    for (auto row = static_cast<std::int64_t>(first); row < static_cast<std::int64_t>(last); ++row) {
      const double share = (static_cast<double>(row) - low.y()) / (high.y() - low.y());
      const double column = std::ceil(low.x() + share * (high.x() - low.x()));
      const auto at = static_cast<std::int64_t>(std::clamp(column, 0.0, static_cast<double>(columns_)));
      turns_[static_cast<std::size_t>(row * (columns_ + 1) + at)] ^= 1;
    }
  }

  std::int64_t columns_;
  std::int64_t rows_;
  std::vector<std::uint8_t> turns_;
};

void fill_contours(const ContourPlane& plane, const ContourGrid& grid, std::int64_t first, std::int64_t last,
                   std::vector<std::uint8_t>& mask) {
  const auto u = static_cast<std::size_t>((grid.axis + 1) % 3);
  const auto v = static_cast<std::size_t>((grid.axis + 2) % 3);
  PlaneFill fill(grid.geometry.size[u], grid.geometry.size[v]);
  for (const FlatContour* contour : plane.contours) fill.add(*contour);
  fill.for_inside([&](std::int64_t column, std::int64_t row) {
    volume::Index3 ijk{};
    ijk[u] = column;
    ijk[v] = row;
    for (std::int64_t w = first; w < last; ++w) {
      ijk[static_cast<std::size_t>(grid.axis)] = w;
      mask[grid.geometry.offset(ijk)] = 1;
    }
  });
}

/// A grid along contours that are parallel to no plane of the CT, with the CT's finest spacing in their planes.
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
  std::sort(along_mm.begin(), along_mm.end());
  double gap_mm = HUGE_VAL;
  for (std::size_t n = 1; n < along_mm.size(); ++n)
    if (along_mm[n] - along_mm[n - 1] > kContoursOfOnePlane_mm)
      gap_mm = std::min(gap_mm, along_mm[n] - along_mm[n - 1]);
  if (std::isfinite(gap_mm)) g.spacing_mm.z() = gap_mm;
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
  std::vector<ContourPlane> planes = group_planes(flat, grid.geometry.spacing_mm[grid.axis], result.repeated);
  set_reach(planes, result);
  const std::int64_t count = grid.geometry.size[static_cast<std::size_t>(grid.axis)];
  const auto to_plane = [&](double w) {
    return static_cast<std::int64_t>(std::clamp(std::ceil(w), 0.0, static_cast<double>(count)));
  };
  for (const ContourPlane& plane : planes) {
    const std::int64_t first = to_plane(plane.low);
    const std::int64_t last = to_plane(plane.high);
    if (first < last) fill_contours(plane, grid, first, last, result.mask);
  }
  return result;
}

}  // namespace trocar::dicom::detail
