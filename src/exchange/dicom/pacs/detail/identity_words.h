#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>

namespace trocar::dicom::detail {

/// True for elements whose value names a person or a case: names, numbers, addresses, institutions.
bool is_identifying(std::uint32_t tag) noexcept;

/// The words that identify the patient of one object, and texts without them.
class IdentityWords {
 public:
  /// Adds the words of an identifying value. Single letters are left out.
  void add(std::string_view value);

  /// The text without these words, without words that contain one of them, and without words that hold five or more
  /// digits (dates, numbers of patients). `keeps_anatomy`: names of structures such as "liver" always stay; research
  /// data often use them as names of patients.
  std::string cleaned(std::string_view text, bool keeps_anatomy) const;

 private:
  bool is_removed(std::string_view word, bool keeps_anatomy) const;
  std::set<std::string, std::less<>> words_;  ///< In lower case.
};

}  // namespace trocar::dicom::detail
