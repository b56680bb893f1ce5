#include "dicom/pacs/detail/text_codes.h"

#include <fmt/format.h>

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

}  // namespace trocar::dicom::detail
