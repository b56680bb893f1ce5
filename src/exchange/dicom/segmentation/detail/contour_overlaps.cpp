#include "dicom/segmentation/detail/contour_overlaps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

namespace trocar::dicom::detail {
namespace {

constexpr double kSimilarBoxes = 0.7;    ///< Common part of two boxes, of both together.
constexpr double kSameOutline_mm = 0.5;  ///< Mean distance of two drawings of one outline.
constexpr double kPointOnOutline_mm = 0.1;
constexpr double kNestedShare = 0.95;    ///< Of the inner one: holes may be drawn a little over their outline.
constexpr double kInsideShare = 0.995;   ///< More is rounding.
constexpr double kTouchingShare = 1e-3;  ///< Less is rounding.
constexpr double kThinRing = 0.8;        ///< Of the outer one: such a hole may be a second drawing.
constexpr int kAreaLines = 64;           ///< Lines that areas are measured on.
constexpr int kFineRows = 256;

double area_of(const Eigen::AlignedBox2d& box) {
  return box.isEmpty() ? 0.0 : box.sizes().prod();
}

/// Ends of the parts of a line that lie inside a contour, in pairs.
void find_crossings(const FlatContour& contour, double v, std::vector<double>& ends) {
  ends.clear();
  for (std::size_t n = 0; n < contour.points.size(); ++n) {
    const Eigen::Vector2d& a = contour.points[n];
    const Eigen::Vector2d& b = contour.points[(n + 1) % contour.points.size()];
    if ((a.y() <= v) != (b.y() <= v)) ends.push_back(a.x() + (v - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
  }
  std::sort(ends.begin(), ends.end());
}

double length_of(const std::vector<double>& ends) {
  double length = 0.0;
  for (std::size_t n = 0; n + 1 < ends.size(); n += 2) length += ends[n + 1] - ends[n];
  return length;
}

double common_length(const std::vector<double>& a, const std::vector<double>& b) {
  double length = 0.0;
  for (std::size_t n = 0, m = 0; n + 1 < a.size() && m + 1 < b.size();) {
    length += std::max(0.0, std::min(a[n + 1], b[m + 1]) - std::max(a[n], b[m]));
    if (a[n + 1] < b[m + 1])
      n += 2;
    else
      m += 2;
  }
  return length;
}

struct Areas {
  double a = 0.0;
  double b = 0.0;
  double common = 0.0;
};

/// Areas between two places of v, in pixels, on lines in the middle of as many stripes.
Areas measure(const FlatContour& a, const FlatContour& b, double low, double high, int rows) {
  Areas areas;
  std::vector<double> ends_a, ends_b;
  const double step = (high - low) / rows;
  for (int row = 0; row < rows; ++row) {
    const double v = low + (row + 0.5) * step;
    find_crossings(a, v, ends_a);
    find_crossings(b, v, ends_b);
    areas.a += step * length_of(ends_a);
    areas.b += step * length_of(ends_b);
    areas.common += step * common_length(ends_a, ends_b);
  }
  return areas;
}

double perimeter_mm(const FlatContour& contour, const Eigen::Vector2d& pixel_mm) {
  double sum_mm = 0.0;
  for (std::size_t n = 0; n < contour.points.size(); ++n)
    sum_mm += (contour.points[(n + 1) % contour.points.size()] - contour.points[n]).cwiseProduct(pixel_mm).norm();
  return sum_mm;
}

double distance_mm(const Eigen::Vector2d& point, const FlatContour& contour, const Eigen::Vector2d& pixel_mm) {
  double least_mm = HUGE_VAL;
  for (std::size_t n = 0; n < contour.points.size(); ++n) {
    const Eigen::Vector2d edge =
        (contour.points[(n + 1) % contour.points.size()] - contour.points[n]).cwiseProduct(pixel_mm);
    const Eigen::Vector2d to_point = (point - contour.points[n]).cwiseProduct(pixel_mm);
    const double share = edge.squaredNorm() > 0.0 ? std::clamp(to_point.dot(edge) / edge.squaredNorm(), 0.0, 1.0) : 0.0;
    least_mm = std::min(least_mm, (to_point - share * edge).norm());
  }
  return least_mm;
}

/// A copy of an outline with fewer points.
bool is_thinned_copy(const FlatContour& a, const FlatContour& b, const Eigen::Vector2d& pixel_mm) {
  const bool a_is_coarse = a.points.size() < b.points.size();
  const FlatContour& coarse = a_is_coarse ? a : b;
  const FlatContour& fine = a_is_coarse ? b : a;
  return std::all_of(coarse.points.begin(), coarse.points.end(), [&](const Eigen::Vector2d& point) {
    return distance_mm(point, fine, pixel_mm) <= kPointOnOutline_mm;
  });
}

/// Groups of the elements 0 … count - 1.
class Clusters {
 public:
  explicit Clusters(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t find(std::size_t n) {
    while (parent_[n] != n) n = parent_[n] = parent_[parent_[n]];
    return n;
  }
  void join(std::size_t a, std::size_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace

OutlinePair relate_outlines(const FlatContour& a, const FlatContour& b, const Eigen::Vector2d& pixel_mm) {
  OutlinePair pair;
  if (!a.box.intersects(b.box)) return pair;
  const double pixel_mm2 = pixel_mm.prod();
  const Eigen::AlignedBox2d merged = a.box.merged(b.box);
  const bool is_similar = area_of(a.box.intersection(b.box)) > kSimilarBoxes * area_of(merged);
  const FlatContour& small = area_of(a.box) < area_of(b.box) ? a : b;
  const Areas areas = is_similar ? measure(a, b, merged.min().y(), merged.max().y(), kFineRows)
                                 : measure(a, b, small.box.min().y(), small.box.max().y(), kAreaLines);
  const double inner = is_similar ? std::min(areas.a, areas.b) : &small == &a ? areas.a : areas.b;
  pair.common_mm2 = areas.common * pixel_mm2;
  if (areas.common <= kTouchingShare * inner) return pair;
  if (is_similar) {
    const double between_mm2 = (areas.a + areas.b - 2.0 * areas.common) * pixel_mm2;
    const double outline_mm = std::max(perimeter_mm(a, pixel_mm), perimeter_mm(b, pixel_mm));
    if (between_mm2 <= kSameOutline_mm * outline_mm || is_thinned_copy(a, b, pixel_mm)) {
      pair.relation = OutlineRelation::kSame;
      return pair;
    }
  }
  // A second drawing of nearly the same size is no hole.
  const bool is_nested = areas.common >= (is_similar ? kInsideShare : kNestedShare) * inner;
  pair.relation = is_nested ? OutlineRelation::kNested : OutlineRelation::kCrossing;
  pair.is_doubtful = is_nested && (areas.common < kInsideShare * inner ||
                                   (is_similar && inner > kThinRing * std::max(areas.a, areas.b)));
  return pair;
}

CombinedOutlines combine_outlines(const std::vector<const FlatContour*>& contours, const Eigen::Vector2d& pixel_mm,
                                  bool is_exclusive_or) {
  CombinedOutlines result;
  std::vector<bool> is_left_out(contours.size(), false);
  std::vector<std::tuple<std::size_t, std::size_t, OutlinePair>> pairs;
  for (std::size_t n = 0; n < contours.size(); ++n)
    for (std::size_t m = 0; m < n && !is_left_out[n]; ++m) {
      if (is_left_out[m]) continue;
      const OutlinePair pair = relate_outlines(*contours[m], *contours[n], pixel_mm);
      if (pair.relation == OutlineRelation::kSame)
        is_left_out[contours[n]->points.size() > contours[m]->points.size() ? m : n] = true;
      else if (pair.relation == OutlineRelation::kCrossing || pair.is_doubtful)
        pairs.emplace_back(m, n, pair);
    }
  result.repeated = static_cast<std::size_t>(std::count(is_left_out.begin(), is_left_out.end(), true));
  Clusters clusters(contours.size());
  for (const auto& [m, n, pair] : pairs) {
    if (is_left_out[m] || is_left_out[n]) continue;
    const bool is_crossing = pair.relation == OutlineRelation::kCrossing;
    ++(is_crossing ? result.crossing : result.doubtful);
    (is_crossing ? result.crossing_mm2 : result.doubtful_mm2) += pair.common_mm2;
    if (is_crossing && !is_exclusive_or) clusters.join(m, n);
  }
  std::map<std::size_t, std::vector<const FlatContour*>> members;
  for (std::size_t n = 0; n < contours.size(); ++n)
    if (!is_left_out[n]) members[clusters.find(n)].push_back(contours[n]);
  for (auto& [root, together] : members) {
    if (together.size() == 1)
      result.contours.push_back(together.front());
    else
      result.united.push_back(std::move(together));
  }
  return result;
}

}  // namespace trocar::dicom::detail
