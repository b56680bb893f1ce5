#include "scene/detail/appearance.h"

namespace trocar::detail {
namespace {

constexpr Rgb kSkinColor = {224, 178, 150};
constexpr Rgb kIvory = {236, 226, 202};
constexpr double kOrganAroundTargetOpacity = 0.42;
constexpr double kLungOpacity = 0.16;

}  // namespace

std::optional<Appearance> find_appearance(const LabelTable& table, std::string_view name, double skin_opacity) {
  if (name == "skin") {
    if (skin_opacity <= 0.0) return std::nullopt;
    return Appearance{kSkinColor, skin_opacity, 0.1, 0.5};
  }
  const Label* label = table.find(name);
  if (label == nullptr || label->tissue == "adipose" || label->tissue == "muscle") return std::nullopt;
  if (label->tissue == "bone") return Appearance{kIvory, 1.0, 0.15};
  if (label->tissue == "lung") return Appearance{label->color, kLungOpacity, 0.0, 0.5};
  if (label->tissue == "liver") return Appearance{label->color, kOrganAroundTargetOpacity, 0.35, 0.25};
  return Appearance{label->color, 1.0, 0.25};
}

}  // namespace trocar::detail
