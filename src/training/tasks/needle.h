#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace trocar::tasks {

/// A needle as data (data/needles.toml).
struct Needle {
  std::string name;
  std::string title;
  std::string use;                   ///< Intended use: "biopsy", "aspiration", "spinal", "epidural", "ascites".
  std::string model = "chiba";       ///< Appearance: chiba, tuohy, quincke, biopsy-gun or trocar.
  double gauge = 18.0;               ///< Range 7..34.
  double outer_diameter_mm = 1.27;   ///< Range 0.2..5.
  double inner_diameter_mm = 0.838;  ///< Diameter of the bore. Range 0..5, below the outer one; 0: solid.
  double stylet_diameter_mm = 0.0;   ///< Diameter of the rod in the bore; 0: has none. At most the bore's.
  double length_mm = 150.0;          ///< Tip to hub. Range 20..300.
  double bevel_deg = 20.0;           ///< Between the bevel's face and the axis. Range 5..90.
  double bevel_share = 0.1;          ///< Sideways force of the bevel as a share of the tip's axial force. Range 0..1.
  bool is_biopsy = false;
  double throw_mm = 0.0;       ///< Distance that the inner stylet shoots beyond the tip. Range 5..40.
  double notch_mm = 0.0;       ///< Length of the specimen notch. Range 3..40; notch and dead space fit into the throw.
  double dead_space_mm = 0.0;  ///< From the notch's distal end to the stylet's tip. Range 0..15.
  /// A biopsy gun in a coaxial needle: the needle stays where it is while the gun is taken out and loaded.
  bool is_coaxial = false;

  /// From the tip before firing to the middle of the notch after it; 0 for a needle that is not fired.
  double notch_middle_mm() const noexcept { return is_biopsy ? throw_mm - dead_space_mm - 0.5 * notch_mm : 0.0; }
};

/// All needles of the file, in its order. Errors name file, line and key.
Result<std::vector<Needle>> load_needles(const std::filesystem::path& path);
/// Needles that can replace the needle with that name, including itself: made for the same use. Empty if the list lacks
/// it.
std::vector<Needle> needles_like(const std::vector<Needle>& needles, std::string_view name);
/// Unknown name: exit status 2, the message lists the names.
Result<Needle> load_needle(const std::filesystem::path& path, std::string_view name);

}  // namespace trocar::tasks
