#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "anatomy/detail/label_boxes.h"
#include "anatomy/label_table.h"

namespace trocar::anatomy::detail {

// Vertebrae by their place in the spine: C1 is 1, T1 8, L1 20, S1 26, the sacrum 27; 0 is none.
inline constexpr std::uint8_t kT1 = 8, kL1 = 20, kL5 = 24, kS1 = 26, kSacrum = 27;

/// Place of a vertebra in the spine by its name ("vertebrae_L3", "vertebra_L3", "sacrum"); 0: no vertebra.
std::uint8_t vertebra_place(std::string_view name);
/// True if `below` is the next vertebra below `above` and they have a joint: not S1 and the sacrum.
bool are_neighbours(std::uint8_t above, std::uint8_t below) noexcept;

/// The labelled vertebrae of a patient.
struct SpineLabels {
  std::array<std::uint8_t, 256> place{};  ///< By label id.
  std::array<std::uint8_t, 28> id_of{};   ///< By place; 0: not labelled.
  IndexBox box;                           ///< Around all of them.
  int count = 0;
};
SpineLabels find_spine_labels(const LabelTable& table, const LabelBoxes& boxes);

}  // namespace trocar::anatomy::detail
