#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/shapes.h"
#include "patient_builder/detail/label_boxes.h"
#include "patient_builder/repair/detail/repairs.h"
#include "volume/distance.h"
#include "volume/sampling.h"

namespace trocar::patient_builder::detail {
namespace {

// TotalSegmentator leaves out the part of a rib next to its vertebra (its issues 29 and 436). Assumed lengths.
constexpr double kLongestJoinMm = 20.0;  // a longer gap is only a finding
constexpr double kLongestPieceGapMm = 15.0;
constexpr double kSearchMm = 40.0;
constexpr double kRibRadiusMm = 3.5;
constexpr double kBoneHu = 100.0;  // mean along the gap

double mean_hu(const volume::CtGrid& ct, const Vec3& a_P, const Vec3& b_P) {
  constexpr int kSamples = 9;
  double sum = 0.0;
  for (int n = 0; n < kSamples; ++n) sum += volume::sample_linear(ct, a_P + (b_P - a_P) * (n / (kSamples - 1.0)));
  return sum / kSamples;
}

/// Labels the unlabelled voxels within the radius of a rib around a line. Returns their number.
std::size_t paint_line(volume::LabelGrid& labels, const volume::Index3& from, const volume::Index3& to,
                       std::uint8_t id) {
  const volume::GridGeometry& g = labels.geometry;
  const Vec3 a_P = g.centre_mm(from), b_P = g.centre_mm(to);
  IndexBox box;
  box.include(from);
  box.include(to);
  std::size_t painted = 0;
  for_each_in(g, grown(box, kRibRadiusMm, g), [&](std::size_t n, std::size_t, const volume::Index3& ijk) {
    if (labels.voxels[n] != 0) return;
    const Vec3 p_P = g.centre_mm(ijk);
    const double f = std::clamp((p_P - a_P).dot(b_P - a_P) / (b_P - a_P).squaredNorm(), 0.0, 1.0);
    if ((p_P - a_P - f * (b_P - a_P)).norm() > kRibRadiusMm) return;
    labels.voxels[n] = id;
    ++painted;
  });
  return painted;
}

/// The face of one mask that is nearest to another one, and the voxel of that one nearest to its middle.
struct Nearest {
  volume::Index3 a{}, b{};
  double distance_mm = std::numeric_limits<double>::infinity();
};

template <class IsA, class IsB>
Nearest find_nearest(const volume::LabelGrid& labels, const IndexBox& box, const IsA& is_a, const IsB& is_b) {
  const volume::GridGeometry& g = labels.geometry;
  volume::MaskGrid mask(cut_geometry(g, box));
  bool is_any = false;
  for_each_in(g, box, [&](std::size_t n, std::size_t in_box, const volume::Index3&) {
    mask.voxels[in_box] = is_b(n, in_box) ? 1 : 0;
    is_any = is_any || mask.voxels[in_box];
  });
  Nearest nearest;
  if (!is_any) return nearest;
  const volume::FloatGrid to_b_mm = volume::distance_to_mask_mm(mask);
  for_each_in(g, box, [&](std::size_t n, std::size_t in_box, const volume::Index3&) {
    if (is_a(n, in_box))
      nearest.distance_mm = std::min(nearest.distance_mm, static_cast<double>(to_b_mm.voxels[in_box]));
  });
  // The middle of the face that is turned to b, not its corner.
  constexpr double kFaceMm = 1.5;
  const auto is_face = [&](std::size_t n, std::size_t in_box) {
    return is_a(n, in_box) && static_cast<double>(to_b_mm.voxels[in_box]) <= nearest.distance_mm + kFaceMm;
  };
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  for_each_in(g, box, [&](std::size_t n, std::size_t in_box, const volume::Index3& ijk) {
    if (!is_face(n, in_box)) return;
    sum += g.centre_mm(ijk);
    count += 1.0;
  });
  double off_mm = std::numeric_limits<double>::infinity();
  for_each_in(g, box, [&](std::size_t n, std::size_t in_box, const volume::Index3& ijk) {
    if (!is_face(n, in_box) || (g.centre_mm(ijk) - sum / count).norm() >= off_mm) return;
    off_mm = (g.centre_mm(ijk) - sum / count).norm();
    nearest.a = ijk;
  });
  double best = std::numeric_limits<double>::infinity();
  for_each_in(g, box, [&](std::size_t, std::size_t in_box, const volume::Index3& ijk) {
    if (!mask.voxels[in_box]) return;
    const double d = (g.centre_mm(ijk) - g.centre_mm(nearest.a)).norm();
    if (d >= best) return;
    best = d;
    nearest.b = ijk;
  });
  return nearest;
}

void join_pieces(const anatomy::Label& rib, const IndexBox& box, const volume::CtGrid& ct, volume::LabelGrid& labels,
                 std::vector<anatomy::Finding>& repairs) {
  LabelParts parts = find_parts(labels, rib.id, box);
  for (std::size_t part = 1; part < parts.count(); ++part) {
    const auto is_part = [&](std::size_t, std::size_t in_box) {
      return parts.parts.ids.voxels[in_box] == static_cast<std::int32_t>(part + 1);
    };
    const auto is_earlier = [&](std::size_t, std::size_t in_box) {
      const auto id = parts.parts.ids.voxels[in_box];
      return id != 0 && id <= static_cast<std::int32_t>(part);
    };
    const Nearest gap = find_nearest(labels, box, is_part, is_earlier);
    const Vec3 a_P = labels.geometry.centre_mm(gap.a), b_P = labels.geometry.centre_mm(gap.b);
    const bool is_touching = gap.distance_mm <= labels.geometry.spacing_mm.norm() + 1e-3;  // at an edge or a corner
    if (is_touching || gap.distance_mm > kLongestPieceGapMm || mean_hu(ct, a_P, b_P) < kBoneHu) continue;
    paint_line(labels, gap.a, gap.b, rib.id);
    repairs.push_back({fmt::format("joined two pieces of {} across a gap of {:.0f} mm", rib.name, gap.distance_mm),
                       rib.name, 0.5 * (a_P + b_P)});
  }
}

}  // namespace

std::vector<RibGap> find_rib_gaps(const volume::LabelGrid& labels, const anatomy::LabelTable& table,
                                  const LabelBoxes& boxes) {
  const SpineLabels spine = find_spine_labels(table, boxes);
  const double touching_mm = 1.5 * labels.geometry.spacing_mm.maxCoeff() + 1.0;
  std::vector<RibGap> gaps;
  for (const anatomy::Label& label : table.labels) {
    const int number = rib_number(label);
    const std::uint8_t vertebra =
        number > 0 ? spine.id_of[static_cast<std::size_t>(kT1 + number - 1)] : std::uint8_t{0};
    if (vertebra == 0 || boxes.voxels[label.id] == 0) continue;
    // Only the region of the vertebra matters.
    IndexBox box = grown(boxes.box[vertebra], kSearchMm, labels.geometry);
    const IndexBox rib_box = grown(boxes.box[label.id], kSearchMm, labels.geometry);
    for (std::size_t a = 0; a < 3; ++a) {
      box.low[a] = std::max(box.low[a], rib_box.low[a]);
      box.high[a] = std::min(box.high[a], rib_box.high[a]);
    }
    if (box.is_empty()) continue;
    const auto is = [&](std::uint8_t id) {
      return [&labels, id](std::size_t n, std::size_t) { return labels.voxels[n] == id; };
    };
    const Nearest nearest = find_nearest(labels, box, is(label.id), is(vertebra));
    if (nearest.distance_mm <= touching_mm || nearest.distance_mm > kSearchMm) continue;
    gaps.push_back({label.id, vertebra, nearest.a, nearest.b, nearest.distance_mm});
  }
  return gaps;
}

void join_ribs(const volume::CtGrid& ct, volume::LabelGrid& labels, const anatomy::LabelTable& table,
               std::vector<anatomy::Finding>& repairs) {
  const LabelBoxes boxes = find_label_boxes(labels);
  for (const anatomy::Label& label : table.labels)
    if (rib_number(label) != 0 && boxes.voxels[label.id] > 0)
      join_pieces(label, boxes.box[label.id], ct, labels, repairs);
  for (const RibGap& gap : find_rib_gaps(labels, table, boxes)) {
    const Vec3 a_P = labels.geometry.centre_mm(gap.from), b_P = labels.geometry.centre_mm(gap.to);
    if (gap.length_mm > kLongestJoinMm || mean_hu(ct, a_P, b_P) < kBoneHu) continue;
    paint_line(labels, gap.from, gap.to, gap.rib);
    repairs.push_back({fmt::format("joined {} and {} across a gap of {:.0f} mm", table.find(gap.rib)->name,
                                   table.find(gap.vertebra)->name, gap.length_mm),
                       table.find(gap.rib)->name, 0.5 * (a_P + b_P)});
  }
}

}  // namespace trocar::patient_builder::detail
