#include "anatomy/label_table.h"

#include <algorithm>

namespace trocar {

const Label* LabelTable::find(std::uint8_t id) const noexcept {
  const auto it = std::lower_bound(labels.begin(), labels.end(), id,
                                   [](const Label& label, std::uint8_t wanted) { return label.id < wanted; });
  return it != labels.end() && it->id == id ? &*it : nullptr;
}

const Label* LabelTable::find(std::string_view name) const noexcept {
  const auto it = std::find_if(labels.begin(), labels.end(), [&](const Label& label) { return label.name == name; });
  return it != labels.end() ? &*it : nullptr;
}

}  // namespace trocar
