#include "anatomy/label_table.h"

#include <algorithm>

namespace trocar::anatomy {

const Label* LabelTable::find(std::uint8_t id) const noexcept {
  const auto it = std::lower_bound(labels.begin(), labels.end(), id,
                                   [](const Label& label, std::uint8_t wanted) { return label.id < wanted; });
  return it != labels.end() && it->id == id ? &*it : nullptr;
}

const Label* LabelTable::find(std::string_view name) const noexcept {
  const auto it = std::find_if(labels.begin(), labels.end(), [&](const Label& label) { return label.name == name; });
  return it != labels.end() ? &*it : nullptr;
}

std::array<std::uint8_t, 256> lesions_as_organs(const LabelTable& table) noexcept {
  constexpr std::string_view kLesion = "_lesion";
  std::array<std::uint8_t, 256> organ_of{};
  for (std::size_t id = 0; id < organ_of.size(); ++id) organ_of[id] = static_cast<std::uint8_t>(id);
  for (const Label& label : table.labels) {
    const std::string_view tissue = label.tissue;
    if (!tissue.ends_with(kLesion)) continue;
    const std::string_view around = tissue.substr(0, tissue.size() - kLesion.size());
    const auto organ = std::find_if(table.labels.begin(), table.labels.end(),
                                    [&](const Label& other) { return other.tissue == around; });
    organ_of[label.id] = organ != table.labels.end() ? organ->id : std::uint8_t{0};
  }
  return organ_of;
}

}  // namespace trocar::anatomy
