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

}  // namespace

bool is_name_of_person(std::uint32_t tag) noexcept {
  return std::ranges::find(kNames, tag) != kNames.end();
}

void IdentityWords::add(std::string_view name, Repertoire repertoire) {
  // A name whose characters are not known can still have components in ASCII: PS3.5, 6.2.1.2.
  std::u32string characters(name.begin(), name.end());
  if (const auto known = decoded(name, repertoire)) characters = *known;
  std::u32string word;
  const auto finish = [&] {
    if (word.size() >= kShortestName && words_.size() < kMaxWords) words_.insert(word);
    word.clear();
  };
  for (const char32_t c : characters) {
    if (is_latin_letter(c))
      word += latin_lower_case(c);
    else
      finish();
  }
  finish();
}

}  // namespace trocar::dicom::detail
