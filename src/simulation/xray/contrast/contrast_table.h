#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/result.h"
#include "geometry/vec.h"
#include "volume/grid.h"

namespace trocar::xray {

/// Place of a tip, as contrast agent shows it.
enum class ContrastPlace : unsigned char { kOutside, kDuct, kVessel, kParenchyma, kFluid, kBowel, kTissue };

/// "bile duct", "vessel", "parenchyma", "fluid", "bowel", "tissue", "outside".
std::string contrast_place_words(ContrastPlace place);

/// Parameters of contrast agent in bile ducts. Sources: data/contrast.toml. docs/physics.md, X13.
struct DuctParams {
  double dispersivity_mm = 1.5;   ///< Mixing at a moving front. Range 0..10.
  double mixing_mm2_per_s = 0.5;  ///< Mixing at rest. Range 0..10.
  double papilla_share = 0.3;     ///< Part of an injection that leaves at once through an open papilla. Range 0..0.9.
  double drain_s = 600.0;         ///< Time constant of emptying through an open papilla. Range 10..1e5.
  double distension = 0.25;       ///< Most gain of volume of a full tree without outlet. Range 0..1.
  double bridge_mm = 4.0;         ///< Widest gap within a duct's label. Range 0..20.
};

/// Parameters of contrast agent in vessels. docs/physics.md, X16.
struct VesselParams {
  double washout_s = 0.4;  ///< Time constant of dilution. Range 0.05..5.
  double longest_s = 1.2;  ///< Range 0.1..10.
  double fan_slope = 0.2;  ///< Growth of the stream's radius per length, from the tip to the wall. Range 0.02..1.
};

/// Parameters of contrast agent in a kind of tissue. docs/physics.md, X14, X15.
struct ContrastMedium {
  ContrastPlace place = ContrastPlace::kTissue;  ///< Parenchyma, fluid, bowel or tissue.
  std::vector<std::string> tissues;
  double space = 0.12;  ///< Parenchyma and tissue: share of the volume that is filled. Range 0.01..1.
  double fade_s = 0.0;  ///< Parenchyma and tissue: time constant; 0: no fading. Range 0..1e5.
  double heterogeneity =
      0.0;  ///< Parenchyma and tissue: standard deviation of the logarithm of the uptake. Range 0..2.
  double correlation_mm = 5.0;    ///< Parenchyma and tissue: size of its parts. Range 2..20.
  double mixing_mm2_per_s = 0.0;  ///< Fluid and bowel. Range 0.01..200.
};

struct ContrastTable {
  double iodine_mg_per_ml = 300.0;  ///< Usual agent. Range 1..500.
  DuctParams duct;
  VesselParams vessel;
  std::vector<ContrastMedium> media;  ///< The last one is for the tissues of no list.

  /// Index of the medium of a tissue.
  std::size_t medium_of(const std::string& tissue) const;
};

/// Reads data/contrast.toml. Errors name file and key: unknown or missing key, out of range, no source, a tissue in two
/// lists.
Result<ContrastTable> load_contrast_table(const std::filesystem::path& path);

inline constexpr double kMm3PerMl = 1000.0;

/// A piece of a duct or vessel filled with contrast agent: a truncated cone with round ends.
struct IodinePiece {
  Vec3 a_P, b_P;
  double radius_a_mm = 1.0, radius_b_mm = 1.0;
  double iodine_mg_per_ml = 0.0;
};

/// Contrast agent in the body at one moment: in ducts and vessels as pieces, elsewhere as grids (mg iodine per ml)
/// that cover only where it is and add up: one of tissue, one of fluid. All may be empty.
struct Iodine {
  std::vector<IodinePiece> pieces;
  std::vector<std::shared_ptr<const volume::FloatGrid>> grids_mg_per_ml;
};

}  // namespace trocar::xray
