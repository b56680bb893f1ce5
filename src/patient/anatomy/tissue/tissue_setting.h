#pragma once

#include <string>
#include <string_view>

#include "anatomy/tissue/tissue_table.h"
#include "core/result.h"

namespace trocar::anatomy {

/// A number of a tissue table that a user sets: the parts of "liver.k=0.5". See apply_override for rows, keys and
/// ranges.
struct TissueSetting {
  std::string row;     ///< "liver", "liver_capsule", "layers.skin", "transfer".
  std::string key;     ///< "k", "stiffness_n_per_mm", "tn_factor".
  double value = 0.0;  ///< In the unit of the field; infinite: never punctured.
  bool operator==(const TissueSetting&) const = default;
};

/// `name` is ROW.KEY, as in TissueParameter::setting. Without a dot the row is empty.
TissueSetting make_setting(std::string_view name, double value);
/// Reads ROW.KEY=NUMBER; "never" is infinite. Errors (exit status 2): another form, a number that is not finite.
Result<TissueSetting> parse_setting(std::string_view text);
/// "liver.k", and with the value "liver.k=0.5", which parse_setting reads back to the same setting.
std::string name_of(const TissueSetting& setting);
std::string to_string(const TissueSetting& setting);

/// Same as apply_override with the setting's text.
Status apply_setting(TissueTable& table, const TissueSetting& setting);

}  // namespace trocar::anatomy
