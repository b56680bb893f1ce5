#include "dicom/pacs/detail/identity_words.h"

#include <algorithm>
#include <array>

namespace trocar::dicom::detail {
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
