#include "anatomy/derive/detail/spine_labels.h"

#include <algorithm>
#include <string>

#include "anatomy/structure_pattern.h"

namespace trocar::anatomy::detail {

std::uint8_t vertebra_place(std::string_view name) {
  const std::string plain = plain_name(name);
  if (plain == "sacrum") return kSacrum;
  std::string_view rest = plain;
  for (const std::string_view stem : {"vertebrae", "vertebra"}) {
    if (!rest.starts_with(stem)) continue;
    rest.remove_prefix(stem.size());
    break;
  }
  if (rest.size() == plain.size() || rest.size() < 2 || rest.size() > 3) return 0;
  int number = 0;
  for (const char c : rest.substr(1)) {
    if (c < '0' || c > '9') return 0;
    number = 10 * number + (c - '0');
  }
  const auto place = [&](int most, int first) {
    return number >= 1 && number <= most ? static_cast<std::uint8_t>(first + number - 1) : std::uint8_t{0};
  };
  switch (rest.front()) {
    case 'c':
      return place(7, 1);
    case 't':
      return place(12, kT1);
    case 'l':
      return place(6, kL1);
    case 's':
      return place(1, kS1);
    default:
      return 0;
  }
}

bool are_neighbours(std::uint8_t above, std::uint8_t below) noexcept {
  if (above == 0 || below <= above || above >= kS1) return false;
  if (above >= kL5 && below >= kS1) return true;  // L5 or L6 on S1 or on a sacrum that includes S1
  return below == above + 1;
}

SpineLabels find_spine_labels(const LabelTable& table, const LabelBoxes& boxes) {
  SpineLabels spine;
  for (const Label& label : table.labels) {
    const std::uint8_t place = vertebra_place(label.name);
    if (place == 0 || boxes.voxels[label.id] == 0 || label.tissue != "bone") continue;
    spine.place[label.id] = place;
    spine.id_of[place] = label.id;
    spine.box.include(boxes.box[label.id]);
    ++spine.count;
  }
  return spine;
}

}  // namespace trocar::anatomy::detail
