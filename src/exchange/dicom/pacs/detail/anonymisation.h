#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "dicom/pacs/detail/harmless_words.h"

namespace trocar::dicom::detail {

/// Codes in place of texts: "series-01", "structure-02", "text-03". The same text has the same code as long as this
/// object exists, which is one fetch, so that a structure has one name in all its objects.
class TextCodes {
 public:
  enum class Kind { kSeries, kStructure, kOther };

  std::string code_of(Kind kind, std::string_view text);
  /// Notes a value that was removed without a code.
  void add_removed(std::string_view value);
  /// Different texts that were replaced or removed.
  std::size_t count(Kind kind) const;

 private:
  std::array<std::map<std::string, std::string, std::less<>>, 3> codes_;
  std::set<std::string, std::less<>> removed_;
};

/// Replacements of UIDs and patients: a SHA-256 hash with a random salt. The same original has the same replacement as
/// long as the salt exists, so that references between the objects of one fetch stay valid; without the salt, nobody
/// can find or verify an original.
class Pseudonyms {
 public:
  using Salt = std::array<unsigned char, 32>;

  explicit Pseudonyms(const Salt& salt) noexcept : salt_(salt) {}
  /// With a salt of the system's random numbers.
  static Pseudonyms with_random_salt();

  /// A UID below 2.25 (PS3.5, B.2: a UUID as a decimal number). UIDs that DICOM itself defines stay as they are.
  std::string uid(std::string_view original) const;
  /// "ANON-" and 12 hexadecimal digits.
  std::string patient(std::string_view id) const;

 private:
  using Digest = std::array<unsigned char, 32>;
  Digest digest(char domain, std::string_view original) const;

  Salt salt_;
};

/// Up to 64 digits and dots, as every UID (PS3.5, 9.1).
bool is_uid(std::string_view text) noexcept;

/// What the objects of one fetch are anonymised with.
struct Anonymisation {
  Pseudonyms pseudonyms;
  HarmlessWords words;
  TextCodes codes;  ///< Grows with the texts that are replaced.
};

}  // namespace trocar::dicom::detail
