#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace trocar::dicom::detail {

/// How the bytes of a text are read. Other character sets than these are read as ASCII, so that their other characters
/// are refused and never misread.
enum class Repertoire { kAscii, kLatin1, kUtf8 };

/// True for a value of SpecificCharacterSet that DICOM defines (PS3.3, C.12.1.1.2).
bool is_character_set(std::string_view value);
Repertoire repertoire_of(std::string_view value);

/// The characters of a text. Empty: control characters (escape sequences of ISO 2022, too), bytes that the repertoire
/// does not have, malformed UTF-8.
std::optional<std::u32string> decoded(std::string_view text, Repertoire repertoire);

/// Letters of ASCII and Latin-1; false for all others.
bool is_latin_letter(char32_t c) noexcept;
bool is_latin_capital(char32_t c) noexcept;
/// Small letters of these; other characters as they are.
char32_t latin_lower_case(char32_t c) noexcept;

}  // namespace trocar::dicom::detail
