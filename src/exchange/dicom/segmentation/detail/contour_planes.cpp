#include "dicom/segmentation/detail/contour_planes.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace trocar::dicom::detail {
namespace {

constexpr double kContoursOfOnePlane_mm = 0.05;  ///< Contours of one plane.
constexpr double kClosedGap = 2.1;               ///< Usual distances: one plane without a contour is filled.
constexpr double kClosedJitter = 2.5;            ///< Of the jitter, that a gap may exceed this by.
constexpr double kMuchJitter = 0.25;             ///< Of the usual distance: then planes are out of place by up to
constexpr double kShifted_mm = 2.0;              ///< this much.
constexpr double kSparser = 1.5;                 ///< Of the distance beside a gap: the planes become sparser.
constexpr double kFilledGap = 1.5;               ///< Usual distances: a gap worth telling.
constexpr double kPlanesDrawnTwice = 0.3;        ///< Of the upper quartile: such planes repeat each other,
constexpr double kPlanesDrawnTwice_mm = 1.0;     ///< if they are closer than this.
constexpr double kSparsest = 4.0;                ///< Usual distances: the widest gap of sparser planes.
constexpr double kNextToAStep = 0.25;            ///< Of the grid's step.
constexpr double kFinerThanTheGrid = 0.4;        ///< Of the grid's step: no jitter, but planes drawn finer.
constexpr double kHoleArea = 0.5;                ///< Of the outlines above and below.
constexpr double kHoleDistance = 0.6;            ///< Of the usual distance.
constexpr std::size_t kMostPlanesBetween = 64;   ///< Searched for the next outline of a part.

/// The typical distance, and how far distances are from multiples of it.
struct Spread {
  double usual = 0.0;
  double jitter = 0.0;  ///< Upper quartile.
  double upper = 0.0;   ///< Upper quartile of the distances.
};

double quantile(std::vector<double>& numbers, std::size_t quarters) {
  const auto at = numbers.begin() + static_cast<std::ptrdiff_t>(quarters * (numbers.size() - 1) / 4);
  std::nth_element(numbers.begin(), at, numbers.end());
  return *at;
}

/// Distances in steps of `step_mm`, without the tiny ones of planes that are drawn twice.
std::optional<Spread> spread_of(std::vector<double> gaps, double step_mm) {
  if (gaps.empty()) return std::nullopt;
  const double least = std::min(kPlanesDrawnTwice * quantile(gaps, 3), kPlanesDrawnTwice_mm / step_mm);
  std::erase_if(gaps, [&](double gap) { return gap < least; });
  Spread spread{quantile(gaps, 2), 0.0, quantile(gaps, 3)};
  for (double& gap : gaps) gap = std::abs(gap - std::max(1.0, std::round(gap / spread.usual)) * spread.usual);
  spread.jitter = quantile(gaps, 3);
  return spread;
}

/// Slices that are drawn on, each or every second one, are a better measure than jittered planes.
double rounded_to_steps(double distance) {
  const double steps = std::max(1.0, std::round(distance));
  return std::abs(distance - steps) <= kNextToAStep ? steps : distance;
}

double box_area(const Eigen::AlignedBox2d& box) {
  return box.sizes().prod();
}

/// Contours of one plane whose boxes overlap.
struct Heap {
  std::vector<const FlatContour*> contours;
  Eigen::AlignedBox2d box;
};

/// Adds a contour to the heaps of its plane; it may join several of them.
void add_to_plane(const FlatContour& contour, std::vector<Heap>& plane) {
  Heap joined{{&contour}, contour.box};
  std::erase_if(plane, [&](Heap& heap) {
    if (!heap.box.intersects(joined.box)) return false;
    joined.contours.insert(joined.contours.begin(), heap.contours.begin(), heap.contours.end());
    joined.box.extend(heap.box);
    return true;
  });
  plane.push_back(std::move(joined));
}

std::vector<ContourGroup> group_by_plane(const std::vector<FlatContour>& contours, const ContourGrid& grid,
                                         bool is_exclusive_or) {
  const Vec3& step_mm = grid.geometry.spacing_mm;
  const Eigen::Vector2d pixel_mm(step_mm[(grid.axis + 1) % 3], step_mm[(grid.axis + 2) % 3]);
  std::vector<const FlatContour*> ordered;
  for (const FlatContour& contour : contours) ordered.push_back(&contour);
  std::stable_sort(ordered.begin(), ordered.end(), [](const auto* a, const auto* b) { return a->w < b->w; });
  std::vector<ContourGroup> groups;
  for (std::size_t begin = 0; begin < ordered.size();) {
    const double w = ordered[begin]->w;
    std::vector<Heap> plane;
    for (; begin < ordered.size() && ordered[begin]->w - w <= kContoursOfOnePlane_mm / step_mm[grid.axis]; ++begin)
      add_to_plane(*ordered[begin], plane);
    for (const Heap& heap : plane) {
      const double at = heap.contours.front()->w;
      groups.push_back({combine_outlines(heap.contours, pixel_mm, is_exclusive_or), heap.box, at, at, at});
    }
  }
  std::stable_sort(groups.begin(), groups.end(), [](const auto& a, const auto& b) { return a.w < b.w; });
  return groups;
}

/// The next outlines of the same part below and above each outline.
struct Neighbours {
  std::vector<std::optional<std::size_t>> below, above;
};

/// The first group after `from` (or before it) that lies in another plane and overlaps it, and for which `is_wanted`
/// holds.
template <class IsWanted>
std::optional<std::size_t> next_group(const std::vector<ContourGroup>& groups, std::size_t from, int direction,
                                      const IsWanted& is_wanted) {
  std::size_t planes = 0;
  double w = groups[from].w;
  for (std::size_t n = from; (direction > 0 ? n + 1 < groups.size() : n > 0) && planes <= kMostPlanesBetween;) {
    n = direction > 0 ? n + 1 : n - 1;
    if (groups[n].w == groups[from].w) continue;
    if (groups[n].w != w) ++planes;
    w = groups[n].w;
    if (groups[n].box.intersects(groups[from].box) && is_wanted(groups[n])) return n;
  }
  return std::nullopt;
}

Neighbours find_neighbours(const std::vector<ContourGroup>& groups) {
  const auto any = [](const ContourGroup&) { return true; };
  Neighbours neighbours;
  for (std::size_t n = 0; n < groups.size(); ++n) {
    neighbours.below.push_back(next_group(groups, n, -1, any));
    neighbours.above.push_back(next_group(groups, n, 1, any));
  }
  return neighbours;
}

std::vector<double> gaps_above(const std::vector<ContourGroup>& groups, const Neighbours& neighbours) {
  std::vector<double> gaps;
  for (std::size_t n = 0; n < groups.size(); ++n)
    if (const auto above = neighbours.above[n]) gaps.push_back(groups[*above].w - groups[n].w);
  return gaps;
}

void add_outlines(const CombinedOutlines& more, CombinedOutlines& outlines) {
  outlines.contours.insert(outlines.contours.end(), more.contours.begin(), more.contours.end());
  outlines.united.insert(outlines.united.end(), more.united.begin(), more.united.end());
  outlines.repeated += more.repeated;
  outlines.crossing += more.crossing;
  outlines.crossing_mm2 += more.crossing_mm2;
  outlines.doubtful += more.doubtful;
  outlines.doubtful_mm2 += more.doubtful_mm2;
}

/// A small outline between two much larger ones, close to one of them, is a hole whose plane is rounded or shifted
/// otherwise than that of its outline.
void join_holes(std::vector<ContourGroup>& groups, double step_mm) {
  const Neighbours neighbours = find_neighbours(groups);
  const auto spread = spread_of(gaps_above(groups, neighbours), step_mm);
  if (!spread) return;
  // The distances from holes to outlines are among the others: the larger ones are those of the planes.
  const double usual = spread->upper < kFinerThanTheGrid ? spread->upper : std::max(spread->upper, 1.0);
  std::vector<bool> is_joined(groups.size(), false);
  for (std::size_t n = 0; n < groups.size(); ++n) {
    const ContourGroup& hole = groups[n];
    const auto is_outline = [&](const ContourGroup& other) {
      return other.box.contains(hole.box) && box_area(hole.box) < kHoleArea * box_area(other.box);
    };
    const auto below = next_group(groups, n, -1, is_outline), above = next_group(groups, n, 1, is_outline);
    if (!below || !above) continue;
    const std::size_t closer = hole.w - groups[*below].w <= groups[*above].w - hole.w ? *below : *above;
    if (is_joined[closer] || std::abs(groups[closer].w - hole.w) > kHoleDistance * usual) continue;
    add_outlines(hole.outlines, groups[closer].outlines);
    is_joined[n] = true;
  }
  std::size_t n = 0;
  std::erase_if(groups, [&](const ContourGroup&) { return is_joined[n++]; });
}

/// Decides which gaps are filled.
class Gaps {
 public:
  Gaps(const std::vector<ContourGroup>& groups, const Neighbours& neighbours, const Spread& spread, double usual,
       double step_mm)
      : groups_(groups),
        neighbours_(neighbours),
        filled_(kClosedGap * usual + kClosedJitter * spread.jitter),
        sparsest_(kSparsest * usual) {
    if (spread.jitter > kMuchJitter * usual) filled_ = std::max(filled_, usual + 2.0 * kShifted_mm / step_mm);
  }

  /// The gap between an outline and the next one above it. Where planes become sparser, distances beside it are as
  /// wide.
  bool is_open(std::size_t below, std::size_t above) const {
    const double gap = groups_[above].w - groups_[below].w;
    if (gap <= filled_) return false;
    if (gap > sparsest_) return true;
    return gap > kSparser * std::max(widest_beside(below, neighbours_.below), widest_beside(above, neighbours_.above));
  }

 private:
  /// The wider one of the next two distances in one direction.
  double widest_beside(std::size_t from, const std::vector<std::optional<std::size_t>>& next) const {
    double widest = 0.0;
    for (int n = 0; n < 2 && next[from]; ++n) {
      widest = std::max(widest, std::abs(groups_[*next[from]].w - groups_[from].w));
      from = *next[from];
    }
    return widest;
  }

  const std::vector<ContourGroup>& groups_;
  const Neighbours& neighbours_;
  double filled_;
  double sparsest_;
};

void count_gaps(const std::vector<ContourGroup>& groups, const Neighbours& neighbours, const Gaps& gaps,
                PlaneDistances& distances) {
  for (std::size_t n = 0; n < groups.size(); ++n) {
    if (!neighbours.above[n]) continue;
    const double gap = groups[*neighbours.above[n]].w - groups[n].w;
    if (gaps.is_open(n, *neighbours.above[n])) {
      distances.narrowest_open = distances.open_gaps == 0 ? gap : std::min(distances.narrowest_open, gap);
      ++distances.open_gaps;
    } else if (gap > kFilledGap * distances.usual) {
      distances.widest_filled = std::max(distances.widest_filled, gap);
      ++distances.filled_gaps;
    }
  }
}

/// Half-way to the neighbours first; then an outline whose neighbour is closer to another one reaches up to where the
/// neighbour begins, so that no plane of a branch stays empty.
void set_reach(std::vector<ContourGroup>& groups, const Neighbours& neighbours, const Gaps& gaps, double usual) {
  const auto closed_below = [&](std::size_t n) {
    const auto below = neighbours.below[n];
    return below && !gaps.is_open(*below, n) ? below : std::nullopt;
  };
  const auto closed_above = [&](std::size_t n) {
    const auto above = neighbours.above[n];
    return above && !gaps.is_open(n, *above) ? above : std::nullopt;
  };
  const auto half_way = [&](std::size_t n, std::optional<std::size_t> other, double side) {
    return other ? 0.5 * (groups[n].w + groups[*other].w) : groups[n].w + 0.5 * side * usual;
  };
  std::vector<double> lows, highs;
  for (std::size_t n = 0; n < groups.size(); ++n) {
    lows.push_back(half_way(n, closed_below(n), -1.0));
    highs.push_back(half_way(n, closed_above(n), 1.0));
  }
  for (std::size_t n = 0; n < groups.size(); ++n) {
    const auto below = closed_below(n), above = closed_above(n);
    groups[n].low = below ? std::min(lows[n], highs[*below]) : lows[n];
    groups[n].high = above ? std::max(highs[n], lows[*above]) : highs[n];
  }
}

}  // namespace

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
      out.box.extend(out.points.back());
      sum += index[grid.axis];
    }
    out.w = sum / static_cast<double>(contour.size());
  }
  return flat;
}

GroupedContours group_contours(const std::vector<FlatContour>& contours, const ContourGrid& grid,
                               bool is_exclusive_or) {
  const double step_mm = grid.geometry.spacing_mm[grid.axis];
  GroupedContours result;
  result.groups = group_by_plane(contours, grid, is_exclusive_or);
  join_holes(result.groups, step_mm);
  const Neighbours neighbours = find_neighbours(result.groups);
  const Spread spread = spread_of(gaps_above(result.groups, neighbours), step_mm).value_or(Spread{1.0, 0.0, 1.0});
  result.distances.usual = rounded_to_steps(spread.usual);
  const Gaps gaps(result.groups, neighbours, spread, result.distances.usual, step_mm);
  count_gaps(result.groups, neighbours, gaps, result.distances);
  set_reach(result.groups, neighbours, gaps, result.distances.usual);
  return result;
}

double usual_distance(std::vector<double> places_mm, double fallback_mm) {
  std::sort(places_mm.begin(), places_mm.end());
  std::vector<double> gaps_mm;
  for (std::size_t n = 1; n < places_mm.size(); ++n)
    if (const double gap_mm = places_mm[n] - places_mm[n - 1]; gap_mm > kContoursOfOnePlane_mm)
      gaps_mm.push_back(gap_mm);
  const auto spread = spread_of(std::move(gaps_mm), 1.0);
  return spread ? spread->usual : fallback_mm;
}

}  // namespace trocar::dicom::detail
