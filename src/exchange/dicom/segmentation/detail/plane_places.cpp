#include "dicom/segmentation/detail/plane_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace trocar::dicom::detail {
namespace {

constexpr double kFramesOfOnePlane_mm = 0.01;  ///< Frames of one plane repeat its position; files round it.
constexpr double kMaxOffset = 0.1;             ///< Of the distance of two slices: the frame lies on the slice.
constexpr double kMaxSideways_px = 0.5;        ///< Frames of one plane.
constexpr double kMaxDeviation = 0.05;         ///< Of the step, from a multiple of it.
constexpr double kMaxDeviation_mm = 0.06;      ///< At least this, for positions rounded to a tenth.
constexpr double kFramesParallel = 1e-3;
constexpr double kThicker = 1.25;    ///< Times the distance of the CT's slices: planes of a thicker scan.
constexpr double kOverlap = 0.95;    ///< Of the stated thickness: planes that are closer overlap.
constexpr double kPlaneEdge = 0.01;  ///< Of the thickness: rounding of a slice half-way between two planes.
constexpr std::size_t kMostFramePlanes = 1 << 14;

/// A plane with its distance along the normal.
struct Plane {
  double along_mm = 0.0;
  Vec3 origin_P = Vec3::Zero();
};

/// The planes that have frames, in order, and the plane of each frame.
struct FramePlanes {
  std::vector<Plane> planes;
  std::vector<std::size_t> plane_of_frame;
};

Result<FramePlanes> join_frames(const SegHeader& header, const Vec3& normal_P, const std::string& where) {
  std::vector<std::size_t> order(header.frames.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto along_mm = [&](std::size_t frame) { return normal_P.dot(header.frames[frame].origin_P); };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return along_mm(a) < along_mm(b); });
  const double most_mm = kMaxSideways_px * std::min(header.column_step_mm, header.row_step_mm);
  FramePlanes result;
  result.plane_of_frame.resize(order.size());
  for (const std::size_t frame : order) {
    const Vec3& origin_P = header.frames[frame].origin_P;
    if (result.planes.empty() || along_mm(frame) - result.planes.back().along_mm > kFramesOfOnePlane_mm)
      result.planes.push_back({along_mm(frame), origin_P});
    else if ((origin_P - result.planes.back().origin_P).norm() > most_mm + kFramesOfOnePlane_mm)
      return fail("frames of the DICOM segmentation at one place are shifted sideways", where,
                  kExportSegmentationAgain);
    result.plane_of_frame[frame] = result.planes.size() - 1;
  }
  return result;
}

/// The wider one of the distances from a slice to the next ones; 0 for a single slice.
double gap_beside(const std::vector<double>& slices_mm, std::size_t slice) {
  double gap_mm = 0.0;
  if (slice > 0) gap_mm = slices_mm[slice] - slices_mm[slice - 1];
  if (slice + 1 < slices_mm.size()) gap_mm = std::max(gap_mm, slices_mm[slice + 1] - slices_mm[slice]);
  return gap_mm;
}

/// The plane of a scan that a plane of the segmentation lies on.
std::optional<std::size_t> find_slice(const std::vector<double>& slices_mm, double along_mm) {
  const auto above = std::lower_bound(slices_mm.begin(), slices_mm.end(), along_mm);
  std::size_t nearest = static_cast<std::size_t>(above - slices_mm.begin());
  if (nearest == slices_mm.size() || (nearest > 0 && along_mm - slices_mm[nearest - 1] < slices_mm[nearest] - along_mm))
    --nearest;
  const double allowed_mm = std::max(kMaxOffset * gap_beside(slices_mm, nearest), kMaxDeviation_mm);
  if (std::abs(slices_mm[nearest] - along_mm) > allowed_mm) return std::nullopt;
  return nearest;
}

/// The numbers of the planes among the slices of the CT, if all lie on its slices.
std::optional<std::vector<std::size_t>> on_slices(const std::vector<Plane>& planes,
                                                  const std::vector<double>& slices_mm) {
  std::vector<std::size_t> numbers;
  for (const Plane& plane : planes) {
    const auto slice = slices_mm.empty() ? std::nullopt : find_slice(slices_mm, plane.along_mm);
    if (!slice || (!numbers.empty() && *slice <= numbers.back())) return std::nullopt;
    numbers.push_back(*slice);
  }
  return numbers;
}

/// Distances along the normal of the CT's slices; none if they are unknown or not parallel.
std::vector<double> slice_distances(const CtReference& ct, const Vec3& normal_P) {
  std::vector<double> slices_mm;
  if (ct.slices_P.empty() || ct.grid.R_PV.col(2).cross(normal_P).norm() > kFramesParallel) return slices_mm;
  for (const Vec3& origin_P : ct.slices_P) slices_mm.push_back(normal_P.dot(origin_P));
  std::sort(slices_mm.begin(), slices_mm.end());
  return slices_mm;
}

/// The numbers of the planes in steps of `step_mm`, if all lie on such steps.
std::optional<std::vector<std::size_t>> on_steps(const std::vector<Plane>& planes, double step_mm) {
  std::vector<std::size_t> numbers;
  const double allowed_mm = std::min(std::max(kMaxDeviation * step_mm, kMaxDeviation_mm), 0.25 * step_mm);
  for (const Plane& plane : planes) {
    const double number = (plane.along_mm - planes.front().along_mm) / step_mm;
    if (number > static_cast<double>(kMostFramePlanes) || std::abs(number - std::round(number)) * step_mm > allowed_mm)
      return std::nullopt;
    numbers.push_back(static_cast<std::size_t>(std::llround(number)));
    if (numbers.size() > 1 && numbers.back() <= numbers[numbers.size() - 2]) return std::nullopt;
  }
  return numbers;
}

std::optional<std::vector<std::size_t>> on_even_steps(const SegHeader& header, const std::vector<Plane>& planes) {
  double smallest_mm = HUGE_VAL;
  for (std::size_t n = 1; n < planes.size(); ++n)
    smallest_mm = std::min(smallest_mm, planes[n].along_mm - planes[n - 1].along_mm);
  if (header.slice_step_mm)
    if (auto numbers = on_steps(planes, *header.slice_step_mm)) return numbers;
  return on_steps(planes, smallest_mm);
}

/// Uneven planes: those beyond twice the usual distance have empty ones between them.
std::vector<Plane> with_gaps(const std::vector<Plane>& planes, std::vector<std::size_t>& numbers) {
  std::vector<double> gaps_mm;
  for (std::size_t n = 1; n < planes.size(); ++n) gaps_mm.push_back(planes[n].along_mm - planes[n - 1].along_mm);
  const auto middle = gaps_mm.begin() + static_cast<std::ptrdiff_t>(gaps_mm.size() / 2);
  std::nth_element(gaps_mm.begin(), middle, gaps_mm.end());
  const double usual_mm = *middle;
  std::vector<Plane> all;
  for (std::size_t n = 0; n < planes.size(); ++n) {
    const double gap_mm = n == 0 ? 0.0 : planes[n].along_mm - planes[n - 1].along_mm;
    if (gap_mm > 2.0 * usual_mm)
      for (const double share : {usual_mm / gap_mm, 1.0 - usual_mm / gap_mm})
        all.push_back({planes[n - 1].along_mm + share * gap_mm,
                       planes[n - 1].origin_P + share * (planes[n].origin_P - planes[n - 1].origin_P)});
    numbers.push_back(all.size());
    all.push_back(planes[n]);
  }
  return all;
}

/// Planes 0 … numbers.back() with the known ones in their places, the others in a straight line between them.
std::vector<Plane> fill_between(const std::vector<Plane>& planes, const std::vector<std::size_t>& numbers) {
  std::vector<Plane> all;
  for (std::size_t n = 0; n < planes.size(); ++n) {
    const std::size_t missing = n == 0 ? 0 : numbers[n] - numbers[n - 1] - 1;
    const Plane before = all.empty() ? planes[n] : all.back();
    for (std::size_t m = 1; m <= missing; ++m) {
      const double share = static_cast<double>(m) / static_cast<double>(missing + 1);
      all.push_back({std::lerp(before.along_mm, planes[n].along_mm, share),
                     before.origin_P + share * (planes[n].origin_P - before.origin_P)});
    }
    all.push_back(planes[n]);
  }
  return all;
}

/// The same between slices of the CT, whose steps may differ.
void move_to_slices(std::vector<Plane>& all, std::size_t first_slice, const std::vector<double>& slices_mm,
                    const Vec3& normal_P) {
  for (std::size_t n = 0; n < all.size(); ++n) {
    const double shift_mm = slices_mm[first_slice + n] - all[n].along_mm;
    all[n].origin_P += shift_mm * normal_P;
    all[n].along_mm += shift_mm;
  }
}

/// Thickness of a single plane: as the file says, else as the CT's slices.
double single_step(const SegHeader& header, const CtReference& ct, const Vec3& normal_P) {
  if (header.slice_step_mm) return *header.slice_step_mm;
  for (int axis = 0; axis < 3; ++axis)
    if (ct.grid.R_PV.col(axis).cross(normal_P).norm() <= kFramesParallel) return ct.grid.spacing_mm[axis];
  return header.thickness_mm.value_or(ct.grid.spacing_mm.maxCoeff());
}

/// All planes in order, and the numbers of those that have frames.
struct AllPlanes {
  std::vector<Plane> planes;
  std::vector<std::size_t> numbers;
  std::vector<PlaneRepeat> repeats;
  std::optional<ThickPlanes> thick;
};

AllPlanes on_ct_slices(const std::vector<Plane>& planes, const std::vector<std::size_t>& slices,
                       const std::vector<double>& slices_mm, const Vec3& normal_P) {
  AllPlanes all;
  for (const std::size_t slice : slices) all.numbers.push_back(slice - slices.front());
  all.planes = fill_between(planes, all.numbers);
  move_to_slices(all.planes, slices.front(), slices_mm, normal_P);
  return all;
}

/// Planes that the file makes thicker than the slices of the CT they lie on: they were drawn on a thicker scan. Planes
/// on neighbouring slices are as thick as these, whatever the file states.
std::optional<ThickPlanes> find_thick_planes(const SegHeader& header, const std::vector<std::size_t>& slices,
                                             const std::vector<double>& slices_mm) {
  const double stated_mm = header.slice_step_mm.value_or(header.thickness_mm.value_or(0.0));
  std::optional<ThickPlanes> thick;
  for (std::size_t n = 0; n < slices.size(); ++n) {
    const double gap_mm = gap_beside(slices_mm, slices[n]);
    if (gap_mm > 0.0 && stated_mm > kThicker * gap_mm && (!thick || gap_mm < thick->ct_step_mm))
      thick = ThickPlanes{stated_mm, gap_mm};
    const bool is_next = n > 0 && slices[n] == slices[n - 1] + 1;
    if (is_next && slices_mm[slices[n]] - slices_mm[slices[n - 1]] < kOverlap * stated_mm) return std::nullopt;
  }
  return thick;
}

/// Each plane fills the slices of the CT within its thickness that are closer to no other plane.
AllPlanes over_ct_slices(const std::vector<Plane>& planes, const std::vector<std::size_t>& slices,
                         const ThickPlanes& thick, const std::vector<double>& slices_mm, const Vec3& normal_P) {
  const double low_mm = -(0.5 + kPlaneEdge) * thick.thickness_mm, high_mm = (0.5 - kPlaneEdge) * thick.thickness_mm;
  const auto first_from = [&](double at_mm) {
    const auto found = std::lower_bound(slices_mm.begin(), slices_mm.end(), at_mm);
    return static_cast<std::size_t>(found - slices_mm.begin());
  };
  const std::size_t first = first_from(slices_mm[slices.front()] + low_mm);
  const std::size_t end = first_from(slices_mm[slices.back()] + high_mm);
  AllPlanes all = on_ct_slices(planes, slices, slices_mm, normal_P);
  all.thick = thick;
  all.planes.insert(all.planes.begin(), slices.front() - first, all.planes.front());
  all.planes.resize(end - first, all.planes.back());
  move_to_slices(all.planes, first, slices_mm, normal_P);
  for (std::size_t& number : all.numbers) number += slices.front() - first;
  for (std::size_t slice = first, plane = 0; slice < end; ++slice) {
    const auto from_plane_mm = [&](std::size_t n) { return slices_mm[slice] - slices_mm[slices[n]]; };
    while (plane + 1 < slices.size() && from_plane_mm(plane) + from_plane_mm(plane + 1) >= 0.0) ++plane;
    const double at_mm = from_plane_mm(plane);
    if (slice != slices[plane] && at_mm >= low_mm && at_mm < high_mm)
      all.repeats.push_back({all.numbers[plane], slice - first});
  }
  return all;
}

AllPlanes all_planes(const SegHeader& header, const std::vector<Plane>& planes, const CtReference& ct,
                     const Vec3& normal_P) {
  const std::vector<double> slices_mm = slice_distances(ct, normal_P);
  if (const auto slices = on_slices(planes, slices_mm)) {
    if (const auto thick = find_thick_planes(header, *slices, slices_mm))
      return over_ct_slices(planes, *slices, *thick, slices_mm, normal_P);
    return on_ct_slices(planes, *slices, slices_mm, normal_P);
  }
  AllPlanes all;
  if (planes.size() == 1) {
    all.numbers = {0};
    all.planes = planes;
  } else if (auto even = on_even_steps(header, planes)) {
    all.numbers = *std::move(even);
    all.planes = fill_between(planes, all.numbers);
  } else {
    all.planes = with_gaps(planes, all.numbers);
  }
  return all;
}

}  // namespace

Result<SegPlanes> place_planes(const SegHeader& header, const CtReference& ct, const std::string& where) {
  SegPlanes result;
  result.stack.row_P = header.row_P;
  result.stack.column_P = header.column_P;
  result.stack.column_step_mm = header.column_step_mm;
  result.stack.row_step_mm = header.row_step_mm;
  result.stack.columns = header.columns;
  result.stack.rows = header.rows;
  for (const SegFrame& frame : header.frames) result.stack.origins_P.push_back(frame.origin_P);
  if (!is_sane(result.stack))
    return fail("the positions or the pixel spacing of the DICOM segmentation are not those of a scan", where,
                kExportSegmentationAgain);
  result.stack.origins_P.clear();
  const Vec3 normal_P = result.stack.normal_P();
  TROCAR_TRY(FramePlanes found, join_frames(header, normal_P, where));
  AllPlanes all = all_planes(header, found.planes, ct, normal_P);
  for (const Plane& plane : all.planes) result.stack.origins_P.push_back(plane.origin_P);
  if (all.planes.size() > kMostFramePlanes)
    return fail("the DICOM segmentation has more planes than any scan", where, kExportSegmentationAgain);
  for (const std::size_t plane : found.plane_of_frame) result.plane_of_frame.push_back(all.numbers[plane]);
  result.repeats = std::move(all.repeats);
  result.thick = all.thick;
  result.single_step_mm = single_step(header, ct, normal_P);
  return result;
}

}  // namespace trocar::dicom::detail
