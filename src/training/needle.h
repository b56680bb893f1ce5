#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace trocar {

/// A needle as data (data/needles.toml).
struct Needle {
  std::string name;
  std::string title;
  double gauge = 18.0;
  double outer_diameter_mm = 1.27;  ///< Range 0.2..5.
  double length_mm = 150.0;         ///< Tip to hub. Range 20..300.
  double bevel_deg = 20.0;
  bool is_biopsy = false;
  double throw_mm = 0.0;       ///< How far the inner stylet shoots beyond the tip.
  double notch_mm = 0.0;       ///< Length of the specimen notch.
  double dead_space_mm = 0.0;  ///< From the notch's distal end to the stylet's tip.
};

Result<std::vector<Needle>> load_needles(const std::filesystem::path& path);
Result<Needle> load_needle(const std::filesystem::path& path, std::string_view name);

}  // namespace trocar
