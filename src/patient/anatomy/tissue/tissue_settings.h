#pragma once

#include <string>
#include <vector>

#include "anatomy/tissue/tissue_table.h"

namespace trocar::anatomy {

/// The numbers that a user has set in a table (apply_override), as settings: "skin.fp=6", "tissues.liver.nu=0.01".
std::vector<std::string> user_settings(const TissueTable& table);

/// The settings that change `from` into `to` if both have the same tissues and layers, otherwise only
/// "tissues=replaced". A curve of the transfer functions that was multiplied is "transfer.tn_factor=1.2"; one that
/// changed otherwise is "transfer.tn=replaced".
std::vector<std::string> changed_settings(const TissueTable& from, const TissueTable& to);

}  // namespace trocar::anatomy
