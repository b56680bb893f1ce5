#pragma once

#include <optional>
#include <string>

#include "config/toml.h"

namespace trocar::config {

/// A number of a data table with its source: KEY = {value = 0.46, source = "…", range = [low, high]}.
struct SourcedNumber {
  double value = 0.0;
  std::string source;
  std::optional<Range> range;  ///< Measured spread or, for an assumed number, the plausible range.
};

/// Reads a SourcedNumber. Errors: outside of `allowed`, no source, or a source that begins with "assumed" without a
/// range.
Result<SourcedNumber> read_sourced_number(const TomlTable& table, std::string_view key, Range allowed);

}  // namespace trocar::config
