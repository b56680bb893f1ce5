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

namespace {

constexpr std::size_t kShortestName = 2;
constexpr std::size_t kMaxWords = 1000;  ///< Of one object: bounds the time for hostile ones.

constexpr auto kNames = std::to_array<std::uint32_t>({
    0x00080090,  // ReferringPhysicianName
    0x0008009c,  // ConsultingPhysicianName
    0x00081048,  // PhysiciansOfRecord
    0x00081050,  // PerformingPhysicianName
    0x00081060,  // NameOfPhysiciansReadingStudy
    0x00081070,  // OperatorsName
    0x00100010,  // PatientName
    0x00101001,  // OtherPatientNames
    0x00101005,  // PatientBirthName
    0x00101060,  // PatientMotherBirthName
    0x00321032,  // RequestingPhysician
    0x00700084,  // ContentCreatorName
    0x300600a6,  // ROIInterpreter
});

/// The letters of ASCII that are the bases of U+00C0 to U+017F (Latin-1, Latin Extended-A), and of U+1E00 to U+1EFF
/// (Latin Extended Additional); ' ' for others.
constexpr std::string_view kLatinBases =
    "aaaaaaaceeeeiiiidnooooo ouuuuytsaaaaaaaceeeeiiiidnooooo ouuuuyty"
    "aaaaaaccccccccddddeeeeeeeeeegggggggghhhhiiiiiiiiiiiijjkkklllllll"
    "lllnnnnnn nnoooooooorrrrrrssssssssttttttuuuuuuuuuuuuwwyyyzzzzzzs";
constexpr std::string_view kMoreLatinBases =
    "aabbbbbbccddddddddddeeeeeeeeeeffgghhhhhhhhhhiiiikkkkkkllllllllmm"
    "mmmmnnnnnnnnoooooooopppprrrrrrrrssssssssssttttttttuuuuuuuuuuvvvv"
    "wwwwwwwwwwxxxxyyzzzzzzhtwyas  s aaaaaaaaaaaaaaaaaaaaaaaaeeeeeeee"
    "eeeeeeeeiiiioooooooooooooooooooooooouuuuuuuuuuuuuuyyyyyyyy      ";

/// Base of a letter in any width, in small letters; ' ' for what is none.
char base_letter(char32_t c) {
  constexpr char32_t kFullWidth = 0xff01, kFullWidthEnd = 0xff5e, kLatin = 0xc0, kMoreLatin = 0x1e00;
  if (c >= kFullWidth && c <= kFullWidthEnd) c = c - kFullWidth + U'!';
  if (c >= U'A' && c <= U'Z') return static_cast<char>(c - U'A' + U'a');
  if (c >= U'a' && c <= U'z') return static_cast<char>(c);
  if (c >= kLatin && c - kLatin < kLatinBases.size()) return kLatinBases[c - kLatin];
  if (c >= kMoreLatin && c - kMoreLatin < kMoreLatinBases.size()) return kMoreLatinBases[c - kMoreLatin];
  return ' ';
}

/// Accents that follow their letter.
bool is_combining(char32_t c) {
  return c >= 0x300 && c <= 0x36f;
}

}  // namespace

bool is_name_of_person(std::uint32_t tag) noexcept {
  return std::ranges::find(kNames, tag) != kNames.end();
}

std::string spelling_of(std::u32string_view word) {
  std::string letters;
  for (const char32_t c : word)
    if (const char letter = base_letter(c); letter != ' ') letters += letter;
  std::string key;
  for (const char letter : letters) {
    const char last = key.empty() ? ' ' : key.back();
    const bool is_umlaut = letter == 'e' && (last == 'a' || last == 'o' || last == 'u');
    const bool is_sharp_s = letter == 'z' && last == 's';
    if (letter != last && !is_umlaut && !is_sharp_s) key += letter;
  }
  constexpr std::size_t kShortestStem = 3;
  constexpr std::string_view kEndings = "sen";  // of plurals
  while (key.size() > kShortestStem && kEndings.find(key.back()) != std::string_view::npos) key.pop_back();
  return key;
}

void IdentityWords::add_characters(std::u32string_view characters) {
  std::u32string word;
  const auto finish = [&] {
    if (word.size() >= kShortestName && words_.size() < kMaxWords) words_.insert(spelling_of(word));
    word.clear();
  };
  for (const char32_t c : characters) {
    if (base_letter(c) != ' ')
      word += c;
    else if (!is_combining(c))
      finish();
  }
  finish();
}

void IdentityWords::add(std::string_view name, Repertoire repertoire) {
  const auto known = decoded(name, repertoire);
  if (known) return add_characters(*known);
  // The characters are not known: components in ASCII (PS3.5, 6.2.1.2), and what other sets have in common.
  if (const auto utf8 = decoded(name, Repertoire::kUtf8)) add_characters(*utf8);
  std::u32string bytes;
  for (const char c : name) bytes += static_cast<unsigned char>(c);
  add_characters(bytes);
}

}  // namespace trocar::dicom::detail
