#pragma once

#include <CLI/Option.hpp>
#include <cstdint>
#include <limits>
#include <string_view>

namespace trocar::arguments {

// Every option that takes a number uses one of these functions, which return the option. Each value must be a decimal
// number without other text: "", "nan", "inf", "0x10", "3x" and numbers outside the range are usage errors. The help
// shows the range.

/// A number from `low` to `high`. `unit` is the usual symbol ("mm", "Hz"); empty for a dimensionless number.
CLI::Option* number_within(CLI::Option* option, double low, double high, std::string_view unit);
/// A whole number from `low` to `high`; a leading zero does not make it octal.
CLI::Option* whole_number_within(CLI::Option* option, std::int64_t low, std::int64_t high);
/// A random seed: a whole number from 0 to 2^64 - 1.
CLI::Option* seed_number(CLI::Option* option);

}  // namespace trocar::arguments
