#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "anatomy/tissue/tissue_table.h"

namespace trocar::anatomy {

/// A number of a tissue table that is fitted to a patient (paper A: "an interface to adjust these parameters"), as
/// a window shows it and apply_override takes it.
struct TissueParameter {
  std::string setting;      ///< "liver.k"; its override is setting=VALUE.
  std::string_view key;     ///< "k"; unique within its group.
  std::string_view symbol;  ///< As in the papers, "Δx"; UTF-8, may be empty.
  std::string_view name;    ///< "step of the loading law"
  std::string_view unit;    ///< "N/mm"; empty: none.
  double value = 0.0;       ///< Infinite: never gives way.
  double low = 0.0;         ///< Range that apply_override takes.
  double high = 1.0;
  double log_from = 0.0;      ///< Above 0: shown on a logarithmic scale from here; 0: on a straight one.
  bool may_be_never = false;  ///< "never" is a value.
  bool is_insertion = false;  ///< Felt in the insertion model (paper A),
  bool is_proxy = false;      ///< in the proxy model (paper B),
  bool is_combined = false;   ///< in both together.
  Provenance provenance;
  std::string owner;  ///< Tissue or layer whose number it is, where that is not the group's own.
};

/// The numbers of one tissue with those of its surface; "transfer" is unlabelled tissue over HU.
struct TissueParameterGroup {
  std::string name;  ///< Of the tissue.
  std::vector<TissueParameter> parameters;
};

/// Every number of the table once for each tissue that feels it; two tissues under one surface name the same setting.
/// All tissues but air in the table's order, then "transfer" where the table has transfer functions. A parameter
/// "transfer.X_factor" has the value 1: it is relative to the table.
std::vector<TissueParameterGroup> tissue_parameters(const TissueTable& table);

}  // namespace trocar::anatomy
