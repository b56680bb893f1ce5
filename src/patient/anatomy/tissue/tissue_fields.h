#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "anatomy/tissue/tissue_table.h"
#include "config/toml.h"
#include "config/toml_writer.h"

namespace trocar::anatomy {

/// A number of a tissue or layer, with its names in files and overrides. Private to the tissue table's units.
template <class T>
struct TissueField {
  std::string_view name;
  std::string_view short_name;
  double T::*member;
  config::Range range;
};

inline constexpr std::string_view kPunctureForce = "puncture_force_n";
inline constexpr std::string_view kYoung = "young_kpa";
inline constexpr std::string_view kWall = "wall";

inline constexpr std::array<TissueField<LayerParams>, 4> kLayerFields{{
    {"stiffness_n_per_mm", "k", &LayerParams::stiffness_n_per_mm, {0.001, 50.0}},
    {"viscosity_ns_per_mm", "nu", &LayerParams::viscosity_ns_per_mm, {0.0, 1.0}},
    {"delta_x_mm", "dx", &LayerParams::delta_x_mm, {0.01, 20.0}},
    {kPunctureForce, "fp", &LayerParams::puncture_force_n, {0.01, 100.0}},
}};

inline constexpr std::array<TissueField<TissueParams>, 6> kTissueFields{{
    {"viscosity_ns_per_mm", "nu", &TissueParams::viscosity_ns_per_mm, {0.0, 1.0}},
    {"friction_mu", "mu", &TissueParams::friction_mu, {0.0, 2.0}},
    {"roughness_n", "delta", &TissueParams::roughness_n, {0.0, 5.0}},
    {"stick_n_per_mm", "stick", &TissueParams::stick_n_per_mm, {0.0, 0.1}},
    {"cutting_n", "fc", &TissueParams::cutting_n, {0.0, 10.0}},
    {kYoung, "young", &TissueParams::young_kpa, {0.0, 1e6}},
}};

/// Fields of a layer that a file may omit: zero.
inline constexpr std::array<TissueField<LayerParams>, 3> kOptionalLayerFields{{
    {"for_diameter_mm", "diameter", &LayerParams::for_diameter_mm, {0.0, 5.0}},
    {"load_spread_mm", "spread", &LayerParams::load_spread_mm, {0.0, 10.0}},
    {"pressed_young_kpa", "pressed", &LayerParams::pressed_young_kpa, {0.0, 1000.0}},
}};

inline constexpr std::string_view kNeedleSize = "needle_size";
inline constexpr std::array<TissueField<NeedleSizeLaw>, 5> kNeedleSizeFields{{
    {"diameter_mm", "", &NeedleSizeLaw::diameter_mm, {0.3, 5.0}},
    {"bevel_deg", "", &NeedleSizeLaw::bevel_deg, {5.0, 70.0}},
    {"tearing", "", &NeedleSizeLaw::tearing, {0.0, 100.0}},
    {"spreading", "", &NeedleSizeLaw::spreading, {0.0, 100.0}},
    {"face_friction", "", &NeedleSizeLaw::face_friction, {0.0, 0.35}},
}};

/// Tables stored before there was this field have forces that depend less on the bevel.
inline constexpr std::array<TissueField<NeedleSizeLaw>, 1> kOptionalNeedleSizeFields{{
    {"bevel_power", "", &NeedleSizeLaw::bevel_power, {0.0, 1.0}},
}};

inline constexpr std::string_view kPathConstraint = "path_constraint";
inline constexpr std::array<TissueField<PathConstraintLaw>, 2> kPathConstraintFields{{
    {"force_n", "m0", &PathConstraintLaw::force_n, {0.0, 20.0}},
    {"torque_nmm", "n0", &PathConstraintLaw::torque_nmm, {0.0, 500.0}},
}};

inline constexpr std::string_view kFriction = "friction";
inline constexpr std::string_view kGrowsTo = "grows_to_mm_per_s";
inline constexpr std::array<TissueField<FrictionLaw>, 2> kFrictionFields{{
    {"tip", "tip", &FrictionLaw::tip, {0.0, 5.0}},
    {kGrowsTo, "grows_to", &FrictionLaw::grows_to_mm_per_s, {0.1, 1000.0}},
}};

/// Numbers that may be infinite, written as never = true.
inline constexpr bool may_be_never(std::string_view field) noexcept {
  return field == kPunctureForce || field == kGrowsTo;
}

inline constexpr std::string_view kOrigin = "origin";
inline constexpr std::size_t kLongestOrigin = 200;

inline constexpr std::string_view kSkinThickness = "thickness_mm";
inline constexpr config::Range kSkinThicknessRange{0.5, 6.0};

/// Source of a number that apply_override has set.
inline constexpr std::string_view kOverrideSource = "set by the user";

inline constexpr std::string_view kDefaultProfile = "paper-a";

/// Field with this long or short name, or nullptr.
template <class T>
const TissueField<T>* find_field(std::span<const TissueField<T>> fields, std::string_view key) noexcept {
  for (const TissueField<T>& field : fields)
    if (key == field.name || key == field.short_name) return &field;
  return nullptr;
}

// Text of a table, for the units that write one.

/// Source of a user's value: "set by the user".
Provenance find_provenance(const std::map<std::string, Provenance>& provenance, const std::string& path);
/// Writes KEY = {value = 0.46, source = "…", range = [low, high]}; an infinite value is written as never = true.
void write_number(config::TomlWriter& writer, std::string_view key, double value, const std::string& path,
                  const std::map<std::string, Provenance>& provenance);

/// The curves and numbers of the section [transfer] of a tissue file. Private to the tissue table's units.
inline constexpr std::array<TissueField<HuLaw>, 8> kHuLawFields{{
    {"stiffness_n_per_mm", "k", &HuLaw::stiffness_n_per_mm, {0.01, 50.0}},
    {"normal_n", "tn", &HuLaw::normal_n, {0.0, 200.0}},
    {"tangential_n", "tt", &HuLaw::tangential_n, {0.0, 50.0}},
    {"resistance_n", "r0", &HuLaw::resistance_n, {0.0, 50.0}},
    {"viscosity_ns_per_mm", "c", &HuLaw::viscosity_ns_per_mm, {0.0, 1.0}},
    {"shaft_n_per_mm", "shaft", &HuLaw::shaft_n_per_mm, {0.0, 0.1}},
    {"shaft_viscosity_ns_per_mm", "nu", &HuLaw::shaft_viscosity_ns_per_mm, {0.0, 1.0}},
    {"young_kpa", "young", &HuLaw::young_kpa, {0.0, 1e5}},
}};
inline constexpr std::array<TissueField<HuTransfer>, 3> kGradientFields{{
    {"gradient_scale_mm", "scale", &HuTransfer::gradient_scale_mm, {0.2, 5.0}},
    {"gradient_none_hu_per_mm", "none", &HuTransfer::gradient_none_hu_per_mm, {0.0, 500.0}},
    {"gradient_full_hu_per_mm", "full", &HuTransfer::gradient_full_hu_per_mm, {0.0, 1000.0}},
}};
inline constexpr std::string_view kTransfer = "transfer";
/// An override transfer.FIELD_factor multiplies a curve.
inline constexpr std::string_view kFactorEnding = "_factor";
inline constexpr config::Range kCurveFactorRange{0.1, 10.0};
inline constexpr config::Range kHuRange{-1100.0, 4000.0};

/// Reads [transfer] into table.transfer; no change if the file has none. Errors name the line: knots that do not rise,
/// curves of another length, numbers out of range or without source, thresholds that cross.
Status read_hu_transfer(const config::TomlTable& document, TissueTable& table);

/// Writes [transfer] so that read_hu_transfer returns the same values; nothing for a table without transfer functions.
void write_hu_transfer(config::TomlWriter& writer, const TissueTable& table);

}  // namespace trocar::anatomy
