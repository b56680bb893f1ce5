#pragma once

#include <array>
#include <cstdint>
#include <optional>
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

/// Tissue class and colour of a structure name known out of the box: TotalSegmentator v2, the phantom's names, the mask
/// names of 3D-IRCADb ("livertumor1", "portalvein"), the tissues found from HU ("fat", "muscle", "gas"). Case,
/// separators, side and a number are not looked at. Nothing for an unknown name. Tissue "skin" means a mask of the
/// whole body, which is no structure inside it.
struct KnownStructure {
  std::string_view tissue;
  volume::Rgb color;
  int priority;  ///< Where masks overlap the higher one wins (a tumour over its liver).
};
std::optional<KnownStructure> find_known_structure(std::string_view name);

/// Names of background labels ("background", "air", "Clear Label", "exterior", "unlabeled"), independent of case and
/// separators.
bool is_background_name(std::string_view name);

/// The known names most like an unknown one, best first; only those within a few letters of it (edit distance at most a
/// quarter of the longer name).
std::vector<std::string> similar_structure_names(std::string_view name, std::size_t count = 3);

/// TotalSegmentator v2, task "total": name of a label number (1..117).
std::optional<std::string_view> totalsegmentator_name(int number);

}  // namespace trocar::anatomy
