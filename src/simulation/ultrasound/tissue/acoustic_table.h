#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace trocar::ultrasound {

/// Acoustic properties of a tissue (data/acoustics.toml, with the source of each number).
struct AcousticTissue {
  std::string name;                   ///< A tissue of data/tissues.toml, or one of this table alone: "air", "gel", …
  double speed_m_per_s = 1540.0;      ///< Range 300..4500.
  double density_kg_per_m3 = 1050.0;  ///< Range 1..2500.
  double attenuation_db_per_cm_mhz = 0.5;  ///< One way, at 1 MHz. Range 0..100.
  double attenuation_exponent = 1.0;       ///< Exponent of the frequency in MHz. Range 0.5..2.
  double backscatter_db = 0.0;   ///< Mean level of its speckle relative to liver's, without attenuation. Range -80..30.
  double scatterer_share = 1.0;  ///< Scatterers relative to fully developed speckle. Range 0..1.
  double texture_db_per_hu = 0.0;  ///< Change of its speckle with a CT value above the tissue's mean. Range -1..1.
  double texture_below_db_per_hu = 0.0;  ///< The same below the mean: positive is darker. Range -1..1.
  double roughness = 0.2;                ///< Diffuse fraction of a surface's echo. Range 0..1.
  double strands_per_ml = 0.0;           ///< Sheets of tissue with an echo if perpendicular to the beam. Range 0..20.
  double fibre_db = 0.0;  ///< Depth of the layering along the skin (muscle, fat with septa). Range 0..20.

  /// Z = density times speed, MRayl.
  double impedance_mrayl() const noexcept { return density_kg_per_m3 * speed_m_per_s * 1e-6; }
  double attenuation_db_per_cm(double frequency_mhz) const noexcept;
  /// Change of its speckle at that deviation of the CT from the tissue's mean; limited to +-kMostTexture_db.
  double texture_db(double deviation_hu) const noexcept;
};

/// Upper limit of the texture: an unlabelled structure is not darker relative to its organ than blood. Assumed, range
/// 15..40.
inline constexpr double kMostTexture_db = 28.0;

/// A sheet too thin for CT and labels, on the borders of some tissues with others: it scatters sound to all sides, in
/// proportion to the cosine of the angle, partly as speckle, partly as an even band.
struct AcousticWall {
  std::string name;
  std::vector<std::uint8_t> of;       ///< Tissues that it encloses: it lies outside them,
  std::vector<std::uint8_t> against;  ///< within these.
  double thickness_mm = 1.0;          ///< Range 0.1..10.
  double backscatter_db = 0.0;        ///< As AcousticTissue::backscatter_db.
  /// Level of its even part: sheets that echo in phase over the whole surface, relative to liver's speckle. Range
  /// -80..40.
  double even_db = -80.0;
};

struct AcousticTable {
  std::vector<AcousticTissue> tissues;  ///< [0] is air. At most 127.
  std::vector<AcousticWall> walls;

  std::optional<std::uint8_t> find(std::string_view name) const noexcept;
};

/// Errors name file, tissue and key: the first tissue is not air, unknown key, out of range, no source.
Result<AcousticTable> load_acoustic_table(const std::filesystem::path& path);

/// Amplitude reflected at a plane border under normal incidence: (z2 - z1) / (z2 + z1), -1..1.
double reflection(double z1_mrayl, double z2_mrayl) noexcept;

}  // namespace trocar::ultrasound
