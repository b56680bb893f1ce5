#include "signing/password.h"

#include <sodium.h>

#include <array>
#include <optional>

#include "core/parse_number.h"

namespace trocar::signing {
namespace {

constexpr PasswordWork kMostWork{10, std::size_t{1} << 30};
constexpr std::string_view kParameters = "$argon2id$v=19$m=";  // memory in KiB, then ",t=PASSES,p=1$"

/// The number at the start of `text`, which is shortened by it and by `behind`.
template <class Number>
std::optional<Number> take_number(std::string_view& text, std::string_view behind) {
  const auto number = find_leading_number<Number>(text);
  if (!number || !number->rest.starts_with(behind)) return std::nullopt;
  text = number->rest.substr(behind.size());
  return number->value;
}

std::optional<PasswordWork> find_work(std::string_view hash) {
  if (!hash.starts_with(kParameters)) return std::nullopt;
  hash.remove_prefix(kParameters.size());
  const auto kibibytes = take_number<std::size_t>(hash, ",t=");
  if (!kibibytes || *kibibytes > kMostWork.memory_bytes / 1024) return std::nullopt;
  const auto passes = take_number<unsigned long long>(hash, ",p=1$");
  if (!passes || *passes > kMostWork.passes) return std::nullopt;
  return PasswordWork{*passes, *kibibytes * 1024};
}

}  // namespace

Result<std::string> hash_password(std::string_view password, const PasswordWork& work) {
  if (sodium_init() < 0) return fail("cryptography cannot be used", "libsodium", "reinstall libsodium");
  std::array<char, crypto_pwhash_STRBYTES> hash{};
  if (crypto_pwhash_str_alg(hash.data(), password.data(), password.size(), work.passes, work.memory_bytes,
                            crypto_pwhash_ALG_ARGON2ID13) != 0)
    return fail("there is not enough memory to hash a password", "Argon2id", "end other programs and try again");
  return std::string(hash.data());
}

bool is_password(std::string_view hash, std::string_view password) {
  if (sodium_init() < 0 || hash.size() >= crypto_pwhash_STRBYTES || !find_work(hash)) return false;
  const std::string terminated(hash);
  return crypto_pwhash_str_verify(terminated.c_str(), password.data(), password.size()) == 0;
}

bool needs_rehash(std::string_view hash, const PasswordWork& work) {
  const auto found = find_work(hash);
  return !found || found->passes != work.passes || found->memory_bytes != work.memory_bytes;
}

}  // namespace trocar::signing
