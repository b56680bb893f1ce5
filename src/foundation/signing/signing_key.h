#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/result.h"

namespace trocar::signing {

using PublicKey = std::array<std::uint8_t, 32>;
using Signature = std::array<std::uint8_t, 64>;

/// A secret key of Ed25519 (RFC 8032). The bytes are erased when it is destroyed.
class SigningKey {
 public:
  /// A new random key. Error: libsodium cannot be used.
  static Result<SigningKey> make();
  /// The key of a secret seed. Error: libsodium cannot be used.
  static Result<SigningKey> from_seed(const std::array<std::uint8_t, 32>& seed);
  SigningKey(const SigningKey&) = default;
  SigningKey& operator=(const SigningKey&) = default;
  ~SigningKey();

  Signature sign(std::string_view message) const;
  PublicKey public_key() const noexcept;
  std::array<std::uint8_t, 32> seed() const noexcept;

 private:
  SigningKey() = default;
  std::array<std::uint8_t, 64> bytes_{};  ///< Seed, then public key.
};

bool is_signed_by(const PublicKey& key, std::string_view message, const Signature& signature) noexcept;

/// Lower-case hexadecimal digits.
std::string to_hex(std::span<const std::uint8_t> bytes);
/// Empty: another number of digits, or no hexadecimal digit. Upper and lower case.
std::optional<PublicKey> parse_public_key(std::string_view hex);
std::optional<Signature> parse_signature(std::string_view hex);

/// Reads the key of a station, or makes it: a file for this user alone (mode 0600). Several programs may make it at the
/// same time; all get the same key. Errors: other users may read the file, it holds no key, it cannot be written.
Result<SigningKey> open_station_key(const std::filesystem::path& file);
/// Reads it; error if there is none.
Result<SigningKey> load_station_key(const std::filesystem::path& file);

}  // namespace trocar::signing
