#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "xray/geometry/c_arm.h"

namespace trocar::xray {

/// An X-ray unit: a row of data/carms.toml.
struct CArmPreset {
  std::string name, title;
  CArm arm;                       ///< Angles 0, the largest field.
  std::vector<double> fields_mm;  ///< Edges of the fields that it offers, falling.
  double largest_lao_deg = 90.0;  ///< Reach to the left and to the right.
  double largest_cranial_deg = 45.0;
  double kv = 80.0, aluminium_mm = 3.0, copper_mm = 0.1;  ///< Tube (spectrum.h).
  double detector_mm = 0.6;                               ///< Caesium iodide (beam.h).
};

/// All units, in the file's order. Errors name the line: a number out of range, an arm that check_c_arm refuses.
Result<std::vector<CArmPreset>> load_c_arms(const std::filesystem::path& file);
/// The unit with this name. Error (exit status 2): no such unit; the advice lists them.
Result<CArmPreset> load_c_arm(const std::filesystem::path& file, std::string_view name);

}  // namespace trocar::xray
