#pragma once

#include <optional>
#include <string_view>

#include "anatomy/label_table.h"

namespace trocar::detail {

/// How a surface looks.
struct Appearance {
  Rgb color;
  double opacity = 1.0;   ///< 0..1
  double specular = 0.2;  ///< 0..1
  double ambient = 0.14;  ///< 0..1, the share of its own glow
};

/// Looks of the surface named `name`, a label of the table or "skin"; nothing for what is left out (fat, muscle, a skin
/// of opacity 0).
std::optional<Appearance> find_appearance(const LabelTable& table, std::string_view name, double skin_opacity);

}  // namespace trocar::detail
