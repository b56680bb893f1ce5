#include "signing/signing_key.h"

#include <fmt/format.h>
#include <sodium.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/files/output_file.h"

namespace trocar::signing {
namespace fs = std::filesystem;
namespace {

static_assert(sizeof(PublicKey) == crypto_sign_PUBLICKEYBYTES && sizeof(Signature) == crypto_sign_BYTES);

using Seed = std::array<std::uint8_t, crypto_sign_SEEDBYTES>;
constexpr std::size_t kMostKeyFileBytes = 4096;
constexpr std::string_view kHead = "# Secret key of this Trocar station, by which it signs the results of exams.\n";

const unsigned char* raw(std::string_view text) {
  return reinterpret_cast<const unsigned char*>(text.data());
}

Status start_library() {
  if (sodium_init() < 0) return fail("cryptography cannot be used", "libsodium", "reinstall libsodium");
  return {};
}

template <std::size_t Size>
std::optional<std::array<std::uint8_t, Size>> parse_hex(std::string_view hex) {
  std::array<std::uint8_t, Size> bytes;
  std::size_t length = 0;
  if (hex.size() != 2 * Size) return std::nullopt;
  if (sodium_hex2bin(bytes.data(), Size, hex.data(), hex.size(), nullptr, &length, nullptr) != 0) return std::nullopt;
  return length == Size ? std::optional(bytes) : std::nullopt;
}

}  // namespace

Result<SigningKey> SigningKey::make() {
  TROCAR_TRY_STATUS(start_library());
  Seed seed;
  randombytes_buf(seed.data(), seed.size());
  return from_seed(seed);
}

Result<SigningKey> SigningKey::from_seed(const Seed& seed) {
  TROCAR_TRY_STATUS(start_library());
  SigningKey key;
  PublicKey public_key;
  crypto_sign_seed_keypair(public_key.data(), key.bytes_.data(), seed.data());
  return key;
}

SigningKey::~SigningKey() {
  sodium_memzero(bytes_.data(), bytes_.size());
}

Signature SigningKey::sign(std::string_view message) const {
  Signature signature;
  crypto_sign_detached(signature.data(), nullptr, raw(message), message.size(), bytes_.data());
  return signature;
}

PublicKey SigningKey::public_key() const noexcept {
  PublicKey key;
  std::copy(bytes_.begin() + crypto_sign_SEEDBYTES, bytes_.end(), key.begin());
  return key;
}

Seed SigningKey::seed() const noexcept {
  Seed seed;
  std::copy_n(bytes_.begin(), seed.size(), seed.begin());
  return seed;
}

bool is_signed_by(const PublicKey& key, std::string_view message, const Signature& signature) noexcept {
  return crypto_sign_verify_detached(signature.data(), raw(message), message.size(), key.data()) == 0;
}

std::string to_hex(std::span<const std::uint8_t> bytes) {
  std::string hex;
  for (const std::uint8_t byte : bytes) hex += fmt::format("{:02x}", byte);
  return hex;
}

std::optional<PublicKey> parse_public_key(std::string_view hex) {
  return parse_hex<sizeof(PublicKey)>(hex);
}
std::optional<Signature> parse_signature(std::string_view hex) {
  return parse_hex<sizeof(Signature)>(hex);
}

Result<SigningKey> load_station_key(const fs::path& file) {
  TROCAR_TRY_STATUS(check_private_file(file));
  TROCAR_TRY(std::string text, read_file(file, kMostKeyFileBytes));
  std::optional<Seed> seed;
  if (text.starts_with(kHead)) {
    std::string_view hex = std::string_view(text).substr(kHead.size());
    if (hex.ends_with('\n')) hex.remove_suffix(1);
    seed = parse_hex<sizeof(Seed)>(hex);
  }
  sodium_memzero(text.data(), text.size());
  if (!seed)
    return fail("is no key of a station", file.string(), "restore it, or move it away: the next exam makes a new key");
  return SigningKey::from_seed(*seed);
}

Result<SigningKey> open_station_key(const fs::path& file) {
  std::error_code error;
  if (fs::exists(file, error)) return load_station_key(file);
  TROCAR_TRY(const SigningKey key, SigningKey::make());
  TROCAR_TRY_STATUS(make_parent_folder(file));
  // A link fails if another program was faster; a rename would replace its key.
  std::array<std::uint8_t, 8> unique;
  randombytes_buf(unique.data(), unique.size());
  const fs::path temporary = file.string() + "." + to_hex(unique);
  TROCAR_TRY_STATUS(write_private_file(temporary, fmt::format("{}{}\n", kHead, to_hex(key.seed()))));
  const bool is_linked = ::link(temporary.c_str(), file.c_str()) == 0;
  const int reason = errno;
  fs::remove(temporary, error);
  if (!is_linked && reason != EEXIST)
    return fail(std::string("cannot write: ") + std::strerror(reason), file.string(),
                "choose a folder that you may write to");
  return load_station_key(file);
}

}  // namespace trocar::signing
