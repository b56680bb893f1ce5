#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "volume/image.h"

namespace trocar::anatomy {

/// One structure of the label volume.
struct Label {
  std::uint8_t id = 0;  ///< Value in the label volume; 0 is never a label.
  std::string name;  ///< As in the segmentation, else one of those found from HU: "rib_right_9", "livertumor1", "fat".
  std::string tissue;  ///< Tissue class (TissueTable): "bone", "liver".
  volume::Rgb color{200, 200, 200};
  bool is_derived = false;  ///< Made by the program from HU or from other labels; not in the segmentation.
};

/// All structures of a patient, ordered by id; ids and names are unique.
struct LabelTable {
  std::vector<Label> labels;

  const Label* find(std::uint8_t id) const noexcept;
  const Label* find(std::string_view name) const noexcept;
};

/// For each label id: for a lesion (tissue "X_lesion"), the id of its organ, the first label of tissue "X", or 0 if the
/// table has none; for all other labels, the id itself.
std::array<std::uint8_t, 256> lesions_as_organs(const LabelTable& table) noexcept;

}  // namespace trocar::anatomy
