#include "dicom/pacs/detail/anonymisation.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <cstdint>
#include <random>

#include "core/result.h"

namespace trocar::dicom::detail {
namespace {

constexpr std::array<const char*, 3> kPrefixes{"series", "structure", "text"};
constexpr std::size_t kMaxTexts = 10'000;        ///< Of one kind: bounds the memory for hostile objects.
constexpr std::size_t kMaxRememberedText = 256;  ///< Bytes

}  // namespace

std::string TextCodes::code_of(Kind kind, std::string_view text) {
  const auto index = static_cast<std::size_t>(kind);
  auto& codes = codes_[index];
  text = text.substr(0, kMaxRememberedText);
  if (const auto known = codes.find(text); known != codes.end()) return known->second;
  if (codes.size() == kMaxTexts) return fmt::format("{}-more", kPrefixes[index]);
  std::string code = fmt::format("{}-{:02}", kPrefixes[index], codes.size() + 1);
  codes.emplace(text, code);
  return code;
}

void TextCodes::add_removed(std::string_view value) {
  if (removed_.size() < kMaxTexts) removed_.emplace(value.substr(0, kMaxRememberedText));
}

std::size_t TextCodes::count(Kind kind) const {
  return codes_[static_cast<std::size_t>(kind)].size() + (kind == Kind::kOther ? removed_.size() : 0);
}

namespace {

constexpr std::string_view kRootOfDicom = "1.2.840.10008.";
constexpr std::size_t kMaxUid = 64;

/// The 128-bit number in decimal digits.
std::string decimal(std::array<unsigned char, 16> number) {
  std::string digits;
  do {
    unsigned rest = 0;
    for (unsigned char& byte : number) {
      const unsigned dividend = rest << 8 | byte;
      byte = static_cast<unsigned char>(dividend / 10);
      rest = dividend % 10;
    }
    digits.push_back(static_cast<char>('0' + rest));
  } while (std::ranges::any_of(number, [](unsigned char byte) { return byte != 0; }));
  return {digits.rbegin(), digits.rend()};
}

}  // namespace

bool is_uid(std::string_view text) noexcept {
  return !text.empty() && text.size() <= kMaxUid && text.find_first_not_of("0123456789.") == std::string_view::npos;
}

Pseudonyms Pseudonyms::with_random_salt() {
  std::random_device system;
  Salt salt;
  for (unsigned char& byte : salt) byte = static_cast<unsigned char>(system() & 0xff);
  return Pseudonyms(salt);
}

Pseudonyms::Digest Pseudonyms::digest(char domain, std::string_view original) const {
  std::string text(salt_.begin(), salt_.end());
  text += domain;
  text += original;
  Digest digest;
  TROCAR_CHECK(EVP_Digest(text.data(), text.size(), digest.data(), nullptr, EVP_sha256(), nullptr) == 1);
  return digest;
}

std::string Pseudonyms::uid(std::string_view original) const {
  if (original.starts_with(kRootOfDicom) && is_uid(original)) return std::string(original);
  const Digest hash = digest('u', original);
  std::array<unsigned char, 16> uuid;
  std::copy_n(hash.begin(), uuid.size(), uuid.begin());
  uuid[6] = static_cast<unsigned char>((uuid[6] & 0x0f) | 0x80);  // RFC 9562, version 8: custom
  uuid[8] = static_cast<unsigned char>((uuid[8] & 0x3f) | 0x80);
  return "2.25." + decimal(uuid);
}

std::string Pseudonyms::patient(std::string_view id) const {
  const Digest hash = digest('p', id);
  std::string text = "ANON-";
  for (std::size_t n = 0; n < 6; ++n) text += fmt::format("{:02X}", hash[n]);
  return text;
}

}  // namespace trocar::dicom::detail
