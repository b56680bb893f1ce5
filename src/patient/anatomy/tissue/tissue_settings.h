#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "anatomy/tissue/tissue_table.h"
#include "core/result.h"

namespace trocar::anatomy {

/// The numbers that a user has set in a table (apply_override), as settings: "skin.fp=6", "tissues.liver.nu=0.01".
std::vector<std::string> user_settings(const TissueTable& table);

/// The settings that change `from` into `to` if both have the same tissues and layers, otherwise only
/// "tissues=replaced". A curve of the transfer functions that was multiplied is "transfer.tn_factor=1.2"; one that
/// changed otherwise is "transfer.tn=replaced".
std::vector<std::string> changed_settings(const TissueTable& from, const TissueTable& to);

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
