#pragma once

#include <string>

#include "anatomy/tissue/tissue_fields.h"
#include "anatomy/tissue/tissue_table.h"
#include "config/toml.h"

namespace trocar::anatomy {

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
