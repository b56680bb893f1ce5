#include "scene/detail/appearance.h"

#include <initializer_list>

namespace trocar::scene::detail {
namespace {

constexpr volume::Rgb kSkinColor = {224, 178, 150};
constexpr volume::Rgb kIvory = {236, 226, 202};
constexpr double kSkinOpacity = 0.15;
constexpr double kLungOpacity = 0.16;
constexpr double kFluidOpacity = 0.3;

bool is_one_of(std::string_view tissue, std::initializer_list<std::string_view> list) {
  for (const std::string_view entry : list) {
    if (entry == tissue) return true;
  }
  return false;
}

}  // namespace

std::optional<Appearance> find_appearance(const anatomy::LabelTable& table, std::string_view name) {
  if (name == "skin") return Appearance{kSkinColor, kSkinOpacity, 0.1, 0.5, StructureKind::kSkin};
  const anatomy::Label* label = table.find(name);
  if (label == nullptr) return std::nullopt;
  const std::string& tissue = label->tissue;
  if (is_one_of(tissue, {"adipose", "muscle", "soft_tissue"}))
    return Appearance{label->color, 0.0, 0.1, 0.2, StructureKind::kMuscle};
  if (tissue == "bone") return Appearance{kIvory, 1.0, 0.15, 0.14, StructureKind::kBone};
  if (tissue == "cartilage") return Appearance{label->color, 1.0, 0.25, 0.14, StructureKind::kBone};
  if (tissue == "lung") return Appearance{label->color, kLungOpacity, 0.0, 0.5, StructureKind::kLung};
  if (tissue == "liver") {
    return Appearance{label->color, kOrganAroundTargetOpacity, 0.35, 0.25, StructureKind::kOrgan};
  }
  if (is_one_of(tissue, {"ascites", "fluid", "peritoneum", "pleura"})) {
    return Appearance{label->color, kFluidOpacity, 0.3, 0.3, StructureKind::kOrgan};
  }
  if (is_one_of(tissue, {"vessel", "bile_duct"}))
    return Appearance{label->color, 1.0, 0.25, 0.14, StructureKind::kVessel};
  if (tissue == "liver_lesion") return Appearance{label->color, 1.0, 0.25, 0.2, StructureKind::kTarget};
  if (tissue == "bowel") return Appearance{label->color, 1.0, 0.25, 0.14, StructureKind::kHollowOrgan};
  return Appearance{label->color, 1.0, 0.25};
}

}  // namespace trocar::scene::detail
