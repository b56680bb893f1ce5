#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "anatomy/repair/detail/label_parts.h"
#include "anatomy/repair/detail/repairs.h"
#include "anatomy/structure_pattern.h"

namespace trocar::anatomy::detail {
namespace {

constexpr double kComparable = 0.2;  // assumed: ratio of the two volumes
constexpr double kClearMm = 4.0;     // assumed: centroids nearer to each other decide nothing

/// Two rows of the label table, by index.
struct Pair {
  std::size_t left = 0, right = 0;
};

std::vector<Pair> find_pairs(const LabelTable& table) {
  std::map<std::string, std::pair<std::optional<std::size_t>, std::optional<std::size_t>>> by_name;
  for (std::size_t n = 0; n < table.labels.size(); ++n) {
    const std::string plain = plain_name(table.labels[n].name);
    if (plain.find("left") != std::string::npos) by_name[without_side(plain)].first = n;
    if (plain.find("right") != std::string::npos) by_name[without_side(plain)].second = n;
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
void relabel_parts(volume::LabelGrid& labels, const Label& from, const Label& to, const IndexBox& box, double from_x,
                   double to_x, std::vector<Finding>& repairs) {
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
bool is_judged(const LabelBoxes& boxes, const Label& left, const Label& right) {
  const auto [less, more] = std::minmax(boxes.voxels[left.id], boxes.voxels[right.id]);
  return less > 0 && static_cast<double>(less) >= kComparable * static_cast<double>(more);
}

bool is_wrong(const std::array<double, 256>& x, const Label& left, const Label& right) {
  return x[left.id] + kClearMm < x[right.id];
}

}  // namespace

SideCount count_sides(const volume::LabelGrid& labels, const LabelTable& table) {
  const LabelBoxes boxes = find_label_boxes(labels);
  const auto x = centroids_x(labels, boxes);
  SideCount count;
  for (const Pair& pair : find_pairs(table)) {
    const Label &left = table.labels[pair.left], &right = table.labels[pair.right];
    if (left.is_derived || !is_judged(boxes, left, right)) continue;
    is_wrong(x, left, right) ? ++count.wrong : ++count.right;
  }
  return count;
}

void correct_sides(volume::LabelGrid& labels, LabelTable& table, std::vector<Finding>& repairs) {
  if (count_sides(labels, table).is_mirrored()) return;
  const LabelBoxes boxes = find_label_boxes(labels);
  const auto x = centroids_x(labels, boxes);
  for (const Pair& pair : find_pairs(table)) {
    Label &left = table.labels[pair.left], &right = table.labels[pair.right];
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

}  // namespace trocar::anatomy::detail
