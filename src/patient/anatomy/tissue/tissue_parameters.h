#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "anatomy/tissue/tissue_table.h"

namespace trocar::anatomy {

/// An adjustable number of a tissue table (paper A: "an interface to adjust these parameters"), in the form used by a
/// window and by apply_override.
struct TissueParameter {
  std::string setting;      ///< "liver.k"; its override is setting=VALUE.
  std::string_view key;     ///< "k"; unique within its group.
  std::string_view symbol;  ///< As in the papers, "Δx"; UTF-8, may be empty.
  std::string_view name;    ///< "step of the loading law"
  std::string_view unit;    ///< "N/mm"; empty: none.
  double value = 0.0;       ///< Infinite: never punctured.
  double low = 0.0;         ///< Range accepted by apply_override.
  double high = 1.0;
  double log_from = 0.0;      ///< Above 0: logarithmic scale from this value; 0: linear scale.
  bool may_be_never = false;  ///< "never" is a value.
  bool is_insertion = false;  ///< Used by the insertion model (paper A).
  bool is_proxy = false;      ///< Used by the proxy model (paper B).
  bool is_combined = false;   ///< Used by the combined model.
  Provenance provenance;
  std::string owner;  ///< Tissue or layer of this number, if it differs from the group.
};

/// The numbers of one tissue with those of its surface; "transfer" is unlabelled tissue over HU.
struct TissueParameterGroup {
  std::string name;  ///< Name of the tissue.
  std::vector<TissueParameter> parameters;
};

/// All numbers of the table, listed once for each tissue that uses them; two tissues with one surface share a setting.
/// Order: all tissues but air as in the table, then "transfer" if present. A "transfer.X_factor" has the value 1: it is
/// relative to the table.
std::vector<TissueParameterGroup> tissue_parameters(const TissueTable& table);

}  // namespace trocar::anatomy
