#pragma once

#include <optional>
#include <string_view>

#include "scene/structure.h"

namespace trocar::scene::detail {

inline constexpr double kOrganAroundTargetOpacity = 0.42;

/// Appearance of a surface.
struct Appearance {
  volume::Rgb color;
  double opacity = 1.0;   ///< 0..1
  double specular = 0.2;  ///< 0..1
  double ambient = 0.14;  ///< 0..1, ambient coefficient
  StructureKind kind = StructureKind::kOrgan;
};

/// Appearance of the surface `name`, a label of the table or "skin"; empty for an unknown name. Structures that would
/// hide the others (fat, muscle) have opacity 0.
std::optional<Appearance> find_appearance(const anatomy::LabelTable& table, std::string_view name);

}  // namespace trocar::scene::detail
