#pragma once

#include <optional>
#include <string_view>

#include "scene/structure.h"

namespace trocar::scene::detail {

inline constexpr double kOrganAroundTargetOpacity = 0.42;

/// How a surface looks.
struct Appearance {
  volume::Rgb color;
  double opacity = 1.0;   ///< 0..1
  double specular = 0.2;  ///< 0..1
  double ambient = 0.14;  ///< 0..1, the share of its own glow
  StructureKind kind = StructureKind::kOrgan;
};

/// Looks of the surface named `name`, a label of the table or "skin"; nothing for an unknown name. What would hide all
/// else (fat, muscle) has opacity 0.
std::optional<Appearance> find_appearance(const anatomy::LabelTable& table, std::string_view name);

}  // namespace trocar::scene::detail
