#pragma once

#include <string_view>

#include "core/result.h"

namespace trocar::signing {

inline constexpr int kShortestPassword = 12, kLongestPassword = 128;  ///< In Unicode code points.
inline constexpr int kShortestPin = 4, kLongestPin = 12;              ///< In digits.

/// Whether a password is easy to guess: words that attackers try first, alone or in a row, with digits and symbols
/// between them or letters written as digits ("P@ssw0rd2024!!"), a short text repeated, or a row of the keyboard or
/// the alphabet. Without regard to case.
bool is_common_password(std::string_view password);

/// The rules for a new password, as ASVS 5.0 V6.2 asks: length, any character of UTF-8, not common, not the name of its
/// account (alone, repeated, or with digits behind it). Errors (exit status 2) name the rule, and never the password.
Status check_new_password(std::string_view password, std::string_view account);

/// 4 to 12 digits, not all the same. Errors: exit status 2.
Status check_new_pin(std::string_view pin);

}  // namespace trocar::signing
