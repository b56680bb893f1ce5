#include "dicom/pacs/detail/character_set.h"

#include <algorithm>
#include <array>

#include "dicom/pacs/detail/data_set.h"

namespace trocar::dicom::detail {
namespace {

// clang-format off
constexpr auto kCharacterSets = std::to_array<std::string_view>({
    "ISO_IR 6", "ISO_IR 13", "ISO_IR 100", "ISO_IR 101", "ISO_IR 109", "ISO_IR 110", "ISO_IR 126", "ISO_IR 127",
    "ISO_IR 138", "ISO_IR 144", "ISO_IR 148", "ISO_IR 166", "ISO_IR 192", "ISO_IR 203", "GB18030", "GBK",
    "ISO 2022 IR 6", "ISO 2022 IR 13", "ISO 2022 IR 58", "ISO 2022 IR 87", "ISO 2022 IR 100", "ISO 2022 IR 101",
    "ISO 2022 IR 109", "ISO 2022 IR 110", "ISO 2022 IR 126", "ISO 2022 IR 127", "ISO 2022 IR 138", "ISO 2022 IR 144",
    "ISO 2022 IR 148", "ISO 2022 IR 149", "ISO 2022 IR 159", "ISO 2022 IR 166", "ISO 2022 IR 203"});
// clang-format on

constexpr char32_t kFirstPrintable = 0x20;
constexpr char32_t kDelete = 0x7f;
constexpr char32_t kLastControl = 0x9f;

bool is_control(char32_t c) {
  return c < kFirstPrintable || (c >= kDelete && c <= kLastControl);
}

/// One character of UTF-8, which is taken off the text. Empty: malformed, overlong, or longer than three bytes.
std::optional<char32_t> take_utf8(std::string_view& text) {
  const auto byte = [&](std::size_t n) { return static_cast<unsigned char>(text[n]); };
  const std::size_t size = byte(0) < 0x80                      ? 1
                           : byte(0) >= 0xc2 && byte(0) < 0xe0 ? 2
                           : (byte(0) & 0xf0) == 0xe0          ? 3
                                                               : 0;
  if (size == 0 || size > text.size()) return std::nullopt;
  char32_t c = size == 1 ? byte(0) : byte(0) & (0xff >> (size + 1));
  for (std::size_t n = 1; n < size; ++n) {
    if ((byte(n) & 0xc0) != 0x80) return std::nullopt;
    c = c << 6 | (byte(n) & 0x3f);
  }
  if (size == 3 && c < 0x800) return std::nullopt;
  text.remove_prefix(size);
  return c;
}

}  // namespace

bool is_character_set(std::string_view value) {
  return std::ranges::find(kCharacterSets, trimmed(value)) != kCharacterSets.end();
}

Repertoire repertoire_of(std::string_view value) {
  const std::string_view name = trimmed(value);
  if (name == "ISO_IR 100") return Repertoire::kLatin1;
  return name == "ISO_IR 192" ? Repertoire::kUtf8 : Repertoire::kAscii;
}

std::optional<std::u32string> decoded(std::string_view text, Repertoire repertoire) {
  constexpr char32_t kFirstBeyondAscii = 0x80;
  std::u32string characters;
  while (!text.empty()) {
    char32_t c = static_cast<unsigned char>(text.front());
    if (c < kFirstBeyondAscii || repertoire == Repertoire::kLatin1) {
      text.remove_prefix(1);
    } else {
      const auto wide = repertoire == Repertoire::kUtf8 ? take_utf8(text) : std::nullopt;
      if (!wide) return std::nullopt;
      c = *wide;
    }
    if (is_control(c)) return std::nullopt;
    characters += c;
  }
  return characters;
}

bool is_latin_capital(char32_t c) noexcept {
  return (c >= U'A' && c <= U'Z') || (c >= U'\u00c0' && c <= U'\u00de' && c != U'\u00d7');
}

bool is_latin_letter(char32_t c) noexcept {
  return is_latin_capital(c) || (c >= U'a' && c <= U'z') || (c >= U'\u00df' && c <= U'\u00ff' && c != U'\u00f7');
}

char32_t latin_lower_case(char32_t c) noexcept {
  return is_latin_capital(c) ? c + 0x20 : c;
}

}  // namespace trocar::dicom::detail
