#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "anatomy/known_structures.h"
#include "patient_builder/detail/label_boxes.h"
#include "patient_builder/repair/detail/repairs.h"

namespace trocar::patient_builder::detail {
namespace {

constexpr double kComparable = 0.2;  // assumed: ratio of the two volumes
constexpr double kClearMm = 4.0;     // assumed: centroids nearer to each other decide nothing

/// Two rows of the label table, by index.
struct Pair {
  std::size_t left = 0, right = 0;
};

std::vector<Pair> find_pairs(const anatomy::LabelTable& table) {
  std::map<std::string, std::pair<std::optional<std::size_t>, std::optional<std::size_t>>> by_name;
  for (std::size_t n = 0; n < table.labels.size(); ++n) {
    const std::string plain = anatomy::plain_name(table.labels[n].name);
    if (plain.find("left") != std::string::npos) by_name[anatomy::without_side(plain)].first = n;
    if (plain.find("right") != std::string::npos) by_name[anatomy::without_side(plain)].second = n;
  }
  std::vector<Pair> pairs;
  for (const auto& [name, pair] : by_name)
    if (pair.first && pair.second) pairs.push_back({*pair.first, *pair.second});
  return pairs;
}

/// Centroid of each label along +x of P (left), mm. Precondition: i runs along +x.
std::array<double, 256> centroids_x(const volume::LabelGrid& labels, const LabelBoxes& boxes) {
  std::array<double, 256> sums{};
  const volume::GridGeometry& g = labels.geometry;
  for (std::size_t row = 0; row < labels.voxels.size(); row += static_cast<std::size_t>(g.size[0]))
    for (std::int64_t i = 0; i < g.size[0]; ++i)
      sums[labels.voxels[row + static_cast<std::size_t>(i)]] += static_cast<double>(i);
  std::array<double, 256> x{};
  for (std::size_t id = 0; id < 256; ++id)
    if (boxes.voxels[id] > 0) x[id] = g.spacing_mm.x() * sums[id] / static_cast<double>(boxes.voxels[id]);
  return x;
}

/// Relabels parts of `from` that lie on the other side of the middle between the two, nearer to `to`.
void relabel_parts(volume::LabelGrid& labels, const anatomy::Label& from, const anatomy::Label& to, const IndexBox& box,
                   double from_x, double to_x, std::vector<anatomy::Finding>& repairs) {
  const LabelParts parts = find_parts(labels, from.id, box);
  if (parts.count() < 2) return;
  std::size_t count = 0;
  double volume_ml = 0.0;
  std::optional<Vec3> place_P;
  for (std::size_t part = 1; part < parts.count(); ++part) {
    const double x = labels.geometry.spacing_mm.x() * static_cast<double>(parts.middle[part][0]);
    if (std::abs(x - to_x) + kClearMm > std::abs(x - from_x)) continue;
    parts.for_each(labels.geometry, part, [&](std::size_t n, const volume::Index3&) { labels.voxels[n] = to.id; });
    if (!place_P) place_P = labels.geometry.centre_mm(parts.middle[part]);
    volume_ml += parts.volume_ml(part);
    ++count;
  }
  if (count > 0)
    repairs.push_back(
        {fmt::format("relabelled {} of {} as {}", amount_text(count, "part", "parts", volume_ml), from.name, to.name),
         to.name, place_P});
}

/// True if both of a pair are large enough to be the structures: a few voxels of one decide nothing.
bool is_judged(const LabelBoxes& boxes, const anatomy::Label& left, const anatomy::Label& right) {
  const auto [less, more] = std::minmax(boxes.voxels[left.id], boxes.voxels[right.id]);
  return less > 0 && static_cast<double>(less) >= kComparable * static_cast<double>(more);
}

bool is_wrong(const std::array<double, 256>& x, const anatomy::Label& left, const anatomy::Label& right) {
  return x[left.id] + kClearMm < x[right.id];
}

}  // namespace

SideCount count_sides(const volume::LabelGrid& labels, const anatomy::LabelTable& table) {
  const LabelBoxes boxes = find_label_boxes(labels);
  const auto x = centroids_x(labels, boxes);
  SideCount count;
  for (const Pair& pair : find_pairs(table)) {
    const anatomy::Label &left = table.labels[pair.left], &right = table.labels[pair.right];
    if (left.is_derived || !is_judged(boxes, left, right)) continue;
    is_wrong(x, left, right) ? ++count.wrong : ++count.right;
  }
  return count;
}

void correct_sides(volume::LabelGrid& labels, anatomy::LabelTable& table, std::vector<anatomy::Finding>& repairs) {
  if (count_sides(labels, table).is_mirrored()) return;
  const LabelBoxes boxes = find_label_boxes(labels);
  const auto x = centroids_x(labels, boxes);
  for (const Pair& pair : find_pairs(table)) {
    anatomy::Label &left = table.labels[pair.left], &right = table.labels[pair.right];
    if (!is_judged(boxes, left, right)) continue;
    if (is_wrong(x, left, right)) {
      std::swap(left.name, right.name);
      repairs.push_back(
          {fmt::format("exchanged the names {} and {}: each was on the other side", left.name, right.name), left.name,
           labels.geometry.centre_mm(find_parts(labels, left.id, boxes.box[left.id]).middle.front())});
      continue;  // parts were counted with the wrong names
    }
    relabel_parts(labels, left, right, boxes.box[left.id], x[left.id], x[right.id], repairs);
    relabel_parts(labels, right, left, boxes.box[right.id], x[right.id], x[left.id], repairs);
  }
}

namespace {

// Assumed limits of an island.
constexpr double kLargestShare = 0.05;  // of the structure's largest part
constexpr double kLargestMl = 5.0;
constexpr double kNearPartMm = 10.0;  // a part nearer than this to the largest one stays
constexpr double kNearRibMm = 30.0;   // ribs break into pieces (fractures, thin slices)
constexpr double kSpeckMl = 0.03;     // is removed unless it touches the structure at an edge or a corner
constexpr double kContact = 0.4;      // share of its surface at another structure of its kind

/// Vertebrae are of one kind, ribs of another; others stand alone.
int kind_of(const anatomy::Label& label) {
  if (vertebra_place(label.name) != 0) return 1;
  return rib_number(label) != 0 ? 2 : 0;
}

/// What a part touches.
struct Surroundings {
  std::uint8_t same_kind = 0;  ///< Label of the same kind at enough of its surface; 0: none.
  /// A rest beside a lesion or vessel that is cut out of the structure, or between other structures: no island.
  bool is_rest = false;
};

Surroundings find_surroundings(const volume::LabelGrid& labels, const anatomy::LabelTable& table,
                               const LabelParts& parts, std::size_t part, int kind) {
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
  for (const anatomy::Label& label : table.labels) {
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

void remove_islands_of(const anatomy::Label& label, const IndexBox& box, volume::LabelGrid& labels,
                       const anatomy::LabelTable& table, std::vector<anatomy::Finding>& repairs) {
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

void remove_islands(volume::LabelGrid& labels, const anatomy::LabelTable& table,
                    std::vector<anatomy::Finding>& repairs) {
  const LabelBoxes boxes = find_label_boxes(labels);
  for (const anatomy::Label& label : table.labels)
    if (is_one_part(label) && boxes.voxels[label.id] > 0)
      remove_islands_of(label, boxes.box[label.id], labels, table, repairs);
}

}  // namespace trocar::patient_builder::detail
