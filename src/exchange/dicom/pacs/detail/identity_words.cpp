#include "dicom/pacs/detail/identity_words.h"

#include <algorithm>
#include <array>

#include "core/ascii.h"
#include "dicom/pacs/detail/data_set.h"

namespace trocar::dicom::detail {
namespace {

constexpr std::size_t kShortest = 2;
constexpr std::size_t kShortestInside = 4;  ///< Shorter words occur in other words by chance.
constexpr int kDigitsOfANumber = 5;
constexpr std::size_t kMaxWords = 1000;  ///< Of one object: bounds the time for hostile ones.

constexpr auto kIdentifying = std::to_array<std::uint32_t>({
    0x00080050,  // AccessionNumber
    0x00080080,  // InstitutionName
    0x00080081,  // InstitutionAddress
    0x00080090,  // ReferringPhysicianName
    0x0008009c,  // ConsultingPhysicianName
    0x00081010,  // StationName
    0x00081040,  // InstitutionalDepartmentName
    0x00081048,  // PhysiciansOfRecord
    0x00081050,  // PerformingPhysicianName
    0x00081060,  // NameOfPhysiciansReadingStudy
    0x00081070,  // OperatorsName
    0x00100010,  // PatientName
    0x00100020,  // PatientID
    0x00100030,  // PatientBirthDate
    0x00101000,  // OtherPatientIDs
    0x00101001,  // OtherPatientNames
    0x00101005,  // PatientBirthName
    0x00101040,  // PatientAddress
    0x00101060,  // PatientMotherBirthName
    0x00102154,  // PatientTelephoneNumbers
    0x00200010,  // StudyID
    0x00321032,  // RequestingPhysician
    0x00380010,  // AdmissionID
    0x00700084,  // ContentCreatorName
    0x300600a6,  // ROIInterpreter
});

constexpr auto kAnatomy = std::to_array<std::string_view>(
    {"abdomen",     "aorta",  "artery",   "biliary", "bladder", "body",  "bone",     "bowel",    "brain",
     "breast",      "colon",  "contrast", "duct",    "ct",      "disc",  "duodenum", "dura",     "fat",
     "gallbladder", "head",   "heart",    "hip",     "kidney",  "left",  "lesion",   "liver",    "lung",
     "mask",        "mr",     "muscle",   "neck",    "nerve",   "organ", "pancreas", "patient",  "pelvis",
     "phantom",     "portal", "prostate", "rib",     "ribs",    "right", "skin",     "spine",    "spleen",
     "stomach",     "target", "thorax",   "tumor",   "tumour",  "vein",  "vena",     "vertebra", "vessel"});

bool is_separator(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x80 && (byte < '0' || (byte > '9' && byte < 'A') || (byte > 'Z' && byte < 'a') || byte > 'z');
}

/// Calls `use` with each word of the text and the separators in front of it.
template <class Use>
void for_each_word(std::string_view text, Use use) {
  while (!text.empty()) {
    const auto begin = static_cast<std::size_t>(std::ranges::find_if_not(text, is_separator) - text.begin());
    const std::string_view gap = text.substr(0, begin);
    text.remove_prefix(begin);
    const auto size = static_cast<std::size_t>(std::ranges::find_if(text, is_separator) - text.begin());
    use(gap, text.substr(0, size));
    text.remove_prefix(size);
  }
}

}  // namespace

bool is_identifying(std::uint32_t tag) noexcept {
  return std::ranges::find(kIdentifying, tag) != kIdentifying.end();
}

void IdentityWords::add(std::string_view value) {
  for_each_word(value, [&](std::string_view, std::string_view word) {
    if (word.size() >= kShortest && words_.size() < kMaxWords) words_.insert(ascii::lower_case(word));
  });
}

bool IdentityWords::is_removed(std::string_view word, bool keeps_anatomy) const {
  const auto digits = std::ranges::count_if(word, [](char c) { return c >= '0' && c <= '9'; });
  if (digits >= kDigitsOfANumber) return true;
  const std::string small = ascii::lower_case(word);
  if (keeps_anatomy && std::ranges::find(kAnatomy, small) != kAnatomy.end()) return false;
  return std::ranges::any_of(words_, [&](const std::string& known) {
    if (keeps_anatomy && std::ranges::find(kAnatomy, known) != kAnatomy.end()) return false;
    return known == small || (known.size() >= kShortestInside && small.find(known) != std::string::npos);
  });
}

std::string IdentityWords::cleaned(std::string_view text, bool keeps_anatomy) const {
  std::string result;
  for_each_word(text, [&](std::string_view gap, std::string_view word) {
    if (!is_removed(word, keeps_anatomy)) result.append(gap).append(word);
  });
  const auto first = result.find_first_not_of(" _-^,.;:");
  return first == std::string::npos ? std::string() : result.substr(first);
}

}  // namespace trocar::dicom::detail
