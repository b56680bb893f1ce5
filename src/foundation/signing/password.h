#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/result.h"

namespace trocar::signing {

/// Work of Argon2id (RFC 9106) for one password. The defaults need about 50 ms and 64 MiB, above the least that
/// OWASP's Password Storage Cheat Sheet names (19 MiB, 2 passes).
struct PasswordWork {
  unsigned long long passes = 2;                     ///< Range 1..10.
  std::size_t memory_bytes = std::size_t{64} << 20;  ///< Range 8 KiB..1 GiB.
};

/// Argon2id of a password or PIN with a random salt: "$argon2id$v=19$m=65536,t=2,p=1$SALT$HASH", with its parameters.
/// Errors: libsodium cannot be used, the memory is not available.
Result<std::string> hash_password(std::string_view password, const PasswordWork& work = {});

/// Whether `hash` is that of `password`. Compares in constant time. False for a malformed hash, and for one that asks
/// for more than 1 GiB or 10 passes. Needs as much time and memory as hash_password.
bool is_password(std::string_view hash, std::string_view password);

/// Whether `hash` has other parameters than `work`, or is malformed: hash the password again at the next login.
bool needs_rehash(std::string_view hash, const PasswordWork& work = {});

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
