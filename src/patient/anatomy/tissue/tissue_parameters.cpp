#include "anatomy/tissue/tissue_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "anatomy/tissue/tissue_fields.h"

namespace trocar::anatomy {
namespace {

/// Force models that use a number (physics.md, table of the models' parts).
struct Felt {
  bool insertion, proxy, combined;
};
constexpr Felt kEverywhere{true, true, true};
constexpr Felt kInsertionAndCombined{true, false, true};
constexpr Felt kInsertionAlone{true, false, false};
constexpr Felt kProxyAndCombined{false, true, true};

/// Display texts of a field of the table.
struct Wording {
  std::string_view key, symbol, name, unit;
  double log_from;
  Felt felt;
};
// Ranges over decades have a logarithmic scale; if the range starts at zero, the scale starts below every default.
constexpr std::array<Wording, 4> kLayerWords{{
    {"k", "k", "stiffness of the surface", "N/mm", 0.001, kEverywhere},
    {"nu", "ν", "viscosity of the surface", "N·s/mm", 1e-4, kInsertionAndCombined},
    {"dx", "Δx", "step of the loading law", "mm", 0.01, kEverywhere},
    {"fp", "F_p", "puncture force", "N", 0.01, kEverywhere},
}};
constexpr std::array<Wording, 6> kTissueWords{{
    {"nu", "ν", "viscosity at the shaft", "N·s/mm", 1e-4, kEverywhere},
    {"mu", "μ", "friction coefficient", "", 0.0, kInsertionAlone},
    {"delta", "δ", "roughness", "N", 0.0, kInsertionAlone},
    {"stick", "s", "holding force at rest", "N/mm", 1e-4, kEverywhere},
    {"fc", "F_c", "cutting force, R₀ of proxy", "N", 0.0, kEverywhere},
    {"young", "E", "Young's modulus", "kPa", 0.1, kProxyAndCombined},
}};
constexpr std::array<Wording, 8> kCurveWords{{
    {"k", "k", "stiffness at the tip", "×", 0.1, kProxyAndCombined},
    {"tn", "T_N", "threshold across a border", "×", 0.1, kProxyAndCombined},
    {"tt", "T_T", "threshold along a border", "×", 0.1, kProxyAndCombined},
    {"r0", "R₀", "resistance of the tip", "×", 0.1, kProxyAndCombined},
    {"c", "c", "viscosity at the tip", "×", 0.1, kProxyAndCombined},
    {"shaft", "s", "dry friction of the shaft", "×", 0.1, kProxyAndCombined},
    {"nu", "ν", "viscosity at the shaft", "×", 0.1, kProxyAndCombined},
    {"young", "E", "Young's modulus", "×", 0.1, kProxyAndCombined},
}};
constexpr std::array<Wording, 3> kGradientWords{{
    {"scale", "h", "gradient distance", "mm", 0.0, kProxyAndCombined},
    {"none", "g_none", "gradient without a border", "HU/mm", 0.0, kProxyAndCombined},
    {"full", "g_full", "gradient of a full border", "HU/mm", 0.0, kProxyAndCombined},
}};
constexpr Wording kThicknessWords{kSkinThickness, "d", "thickness", "mm", 0.0, kEverywhere};

template <class Words>
const Wording& words_of(const Words& words, std::string_view key) noexcept {
  return *std::find_if(words.begin(), words.end(), [&](const Wording& w) { return w.key == key; });
}

TissueParameter parameter_of(const Wording& words, std::string setting, double value, config::Range range) {
  TissueParameter made;
  made.setting = std::move(setting);
  made.key = words.key;
  made.symbol = words.symbol;
  made.name = words.name;
  made.unit = words.unit;
  made.value = value;
  made.low = range.low;
  made.high = range.high;
  made.log_from = words.log_from;
  made.is_insertion = words.felt.insertion;
  made.is_proxy = words.felt.proxy;
  made.is_combined = words.felt.combined;
  return made;
}

/// Collects the numbers of one tissue.
class Collector {
 public:
  Collector(const TissueTable& table, std::size_t tissue) : table_(table), tissue_(table.tissues[tissue]) {
    if (!tissue_.layer) return;
    layer_ = &table.layers[*tissue_.layer];
    const auto first = std::find_if(table.tissues.begin(), table.tissues.end(),
                                    [&](const TissueParams& other) { return other.layer == tissue_.layer; });
    first_ = &*first;
  }

  TissueParameterGroup collect() {
    group_.name = tissue_.name;
    if (&tissue_ == &table_.tissues[table_.skin])
      add(parameter_of(kThicknessWords, "skin.thickness_mm", table_.skin_thickness_mm, kSkinThicknessRange),
          "skin.thickness_mm");
    if (layer_)
      for (const auto& field : kLayerFields)
        if (field.short_name != "nu" || first_ == &tissue_) add_layer_field(field);
    for (const auto& field : kTissueFields)
      if (field.short_name != "nu" || !has_one_viscosity()) add_tissue_field(field);
    return std::move(group_);
  }

 private:
  /// Paper A has one nu for both laws; if the table has two, each is adjusted separately.
  bool has_one_viscosity() const noexcept {
    return layer_ && first_ == &tissue_ && layer_->viscosity_ns_per_mm == tissue_.viscosity_ns_per_mm;
  }

  void add(TissueParameter parameter, const std::string& path) {
    const auto source = table_.provenance.find(path);
    if (source != table_.provenance.end()) parameter.provenance = source->second;
    group_.parameters.push_back(std::move(parameter));
  }

  void add_layer_field(const TissueField<LayerParams>& field) {
    Wording words = words_of(kLayerWords, field.short_name);
    std::string setting = fmt::format("{}.{}", first_->name, field.short_name);
    if (field.short_name == "nu") {
      if (has_one_viscosity()) {
        words.name = "viscosity";
        words.felt = kEverywhere;
      } else {
        words.key = "layer_nu";
        setting = fmt::format("layers.{}.nu", layer_->name);
      }
    } else if (!layer_->is_wall) {
      words.felt = kInsertionAndCombined;  // For the proxy, such a surface is a border in the CT.
    }
    TissueParameter made = parameter_of(words, std::move(setting), layer_->*field.member, field.range);
    made.may_be_never = may_be_never(field.name);
    if (first_ != &tissue_) made.owner = first_->name;
    add(std::move(made), fmt::format("layers.{}.{}", layer_->name, field.name));
  }

  void add_tissue_field(const TissueField<TissueParams>& field) {
    // On the first tissue of a layer, plain nu would change the layer, too.
    const bool is_double = field.short_name == "nu" && first_ == &tissue_;
    std::string setting = fmt::format("{}{}.{}", is_double ? "tissues." : "", tissue_.name, field.short_name);
    add(parameter_of(words_of(kTissueWords, field.short_name), std::move(setting), tissue_.*field.member, field.range),
        fmt::format("tissues.{}.{}", tissue_.name, field.name));
  }

  const TissueTable& table_;
  const TissueParams& tissue_;
  const LayerParams* layer_ = nullptr;
  const TissueParams* first_ = nullptr;  ///< The first tissue of the layer.
  TissueParameterGroup group_;
};

Provenance source_of(const TissueTable& table, std::string_view field) {
  const auto found = table.provenance.find(fmt::format("{}.{}", kTransfer, field));
  return found != table.provenance.end() ? found->second : Provenance{};
}

TissueParameterGroup transfer_group(const TissueTable& table) {
  TissueParameterGroup group;
  group.name = kTransfer;
  for (const auto& field : kHuLawFields) {
    group.parameters.push_back(parameter_of(words_of(kCurveWords, field.short_name),
                                            fmt::format("{}.{}{}", kTransfer, field.short_name, kFactorEnding), 1.0,
                                            kCurveFactorRange));
    group.parameters.back().provenance = source_of(table, field.name);
  }
  for (const auto& field : kGradientFields) {
    group.parameters.push_back(parameter_of(words_of(kGradientWords, field.short_name),
                                            fmt::format("{}.{}", kTransfer, field.short_name),
                                            table.transfer.*field.member, field.range));
    group.parameters.back().provenance = source_of(table, field.name);
  }
  return group;
}

}  // namespace

std::vector<TissueParameterGroup> tissue_parameters(const TissueTable& table) {
  std::vector<TissueParameterGroup> groups;
  for (std::size_t n = 1; n < table.tissues.size(); ++n) groups.push_back(Collector(table, n).collect());
  if (table.transfer.knot_count > 0) groups.push_back(transfer_group(table));
  return groups;
}

}  // namespace trocar::anatomy
