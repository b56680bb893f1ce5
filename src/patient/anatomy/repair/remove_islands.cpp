#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "anatomy/derive/detail/spine_labels.h"
#include "anatomy/repair/detail/label_parts.h"
#include "anatomy/repair/detail/repairs.h"

namespace trocar::anatomy::detail {
namespace {

// Assumed limits of an island.
constexpr double kLargestShare = 0.05;  // of the structure's largest part
constexpr double kLargestMl = 5.0;
constexpr double kNearPartMm = 10.0;  // a part nearer than this to the largest one stays
constexpr double kNearRibMm = 30.0;   // ribs break into pieces (fractures, thin slices)
constexpr double kSpeckMl = 0.03;     // is removed unless it touches the structure at an edge or a corner
constexpr double kContact = 0.4;      // share of its surface at another structure of its kind

/// Vertebrae are of one kind, ribs of another; others stand alone.
int kind_of(const Label& label) {
  if (vertebra_place(label.name) != 0) return 1;
  return rib_number(label) != 0 ? 2 : 0;
}

/// What a part touches.
struct Surroundings {
  std::uint8_t same_kind = 0;  ///< Label of the same kind at enough of its surface; 0: none.
  /// A rest beside a lesion or vessel that is cut out of the structure, or between other structures: no island.
  bool is_rest = false;
};

Surroundings find_surroundings(const volume::LabelGrid& labels, const LabelTable& table, const LabelParts& parts,
                               std::size_t part, int kind) {
  std::array<std::size_t, 256> faces{};
  std::size_t all = 0;
  parts.for_each(labels.geometry, part, [&](std::size_t, const volume::Index3& ijk) {
    for (std::size_t a = 0; a < 3; ++a)
      for (const std::int64_t step : {-1, 1}) {
        volume::Index3 beside = ijk;
        beside[a] += step;
        if (!labels.geometry.contains(beside) || labels[beside] == parts.id) continue;
        ++faces[labels[beside]];
        ++all;
      }
  });
  Surroundings around;
  around.is_rest = 2 * faces[0] < all;
  std::size_t most = 0;
  for (const Label& label : table.labels) {
    const auto share = static_cast<double>(faces[label.id]) / static_cast<double>(std::max<std::size_t>(all, 1));
    if (label.tissue.ends_with("_lesion")) around.is_rest = around.is_rest || share > 0.0;
    if (label.tissue == "vessel" || label.tissue == "bile_duct") around.is_rest = around.is_rest || share >= kContact;
    if (kind == 0 || kind_of(label) != kind || faces[label.id] <= most) continue;
    most = faces[label.id];
    if (static_cast<double>(most) >= kContact * static_cast<double>(all)) around.same_kind = label.id;
  }
  return around;
}

/// What happened to the islands of one structure.
struct Tally {
  std::size_t count = 0;
  double volume_ml = 0.0;
  double farthest_mm = 0.0;
  std::optional<Vec3> place_P;

  void add(double ml, double distance_mm, const Vec3& p_P) {
    if (!place_P || ml > volume_ml) place_P = p_P;
    ++count;
    volume_ml += ml;
    farthest_mm = std::max(farthest_mm, distance_mm);
  }
};

void remove_islands_of(const Label& label, const IndexBox& box, volume::LabelGrid& labels, const LabelTable& table,
                       std::vector<Finding>& repairs) {
  const LabelParts parts = find_parts(labels, label.id, box);
  if (parts.count() < 2) return;
  const std::vector<double> distance_mm = distances_to_main_mm(parts);
  const double largest_ml = std::min(kLargestMl, kLargestShare * parts.volume_ml(0));
  const double near_mm = rib_number(label) != 0 ? kNearRibMm : kNearPartMm;
  const double touching_mm = labels.geometry.spacing_mm.norm() + 1e-3;
  Tally removed;
  std::map<std::uint8_t, Tally> relabelled;
  for (std::size_t part = 1; part < parts.count(); ++part) {
    const double ml = parts.volume_ml(part);
    if (ml > largest_ml) continue;
    const Surroundings around = find_surroundings(labels, table, parts, part, kind_of(label));
    const std::uint8_t other = around.same_kind;
    const double stays_within_mm = ml >= kSpeckMl ? near_mm : touching_mm;
    if (other == 0 && (around.is_rest || distance_mm[part] <= stays_within_mm)) continue;
    const Vec3 place_P = labels.geometry.centre_mm(parts.middle[part]);
    (other != 0 ? relabelled[other] : removed).add(ml, distance_mm[part], place_P);
    parts.for_each(labels.geometry, part, [&](std::size_t n, const volume::Index3&) { labels.voxels[n] = other; });
  }
  for (const auto& [id, tally] : relabelled)
    repairs.push_back(
        {fmt::format("relabelled {} of {} as {}", amount_text(tally.count, "island", "islands", tally.volume_ml),
                     label.name, table.find(id)->name),
         label.name, tally.place_P});
  if (removed.count > 0)
    repairs.push_back({fmt::format("removed {} of {}, up to {:.0f} mm from it",
                                   amount_text(removed.count, "island", "islands", removed.volume_ml), label.name,
                                   removed.farthest_mm),
                       label.name, removed.place_P});
}

}  // namespace

void remove_islands(volume::LabelGrid& labels, const LabelTable& table, std::vector<Finding>& repairs) {
  const LabelBoxes boxes = find_label_boxes(labels);
  for (const Label& label : table.labels)
    if (is_one_part(label) && boxes.voxels[label.id] > 0)
      remove_islands_of(label, boxes.box[label.id], labels, table, repairs);
}

}  // namespace trocar::anatomy::detail
