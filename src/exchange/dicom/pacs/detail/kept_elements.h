#pragma once

#include <cstdint>
#include <span>

namespace trocar::dicom::detail {

/// How the anonymisation treats an element that stays. No text stays unless every word of it is known (harmless_words).
enum class Treatment {
  kKeep,          ///< Binary numbers or pixels: unchanged. Removed if they are text, or the object says so.
  kNumber,        ///< Numbers in decimal digits: emptied if there is anything else, or a number with the digits
                  ///< of a date or of a patient's number.
  kCode,          ///< Defined terms of DICOM and other known words; others become "OTHER".
  kCodeValue,     ///< Code of a public scheme; others are replaced.
  kCodingScheme,  ///< Public scheme; others are replaced.
  kCharacters,    ///< Character set of DICOM; others are emptied.
  kSequence,      ///< Its items are treated element by element.
  kUid,           ///< Replaced, unless DICOM itself defines it.
  kSeries,        ///< Description of a series: replaced by a code if it has an unknown word.
  kStructure,     ///< The same for the name of a structure.
  kText,          ///< The same for any other text.
  kEmpty,         ///< The element stays, its value is removed.
  kDate,          ///< The element must have a value: 1 January 2000.
  kTime,          ///< The element must have a value: midnight.
};

struct KeptElement {
  std::uint32_t tag = 0;
  Treatment treatment = Treatment::kKeep;
};

/// All elements that stay in an anonymised object, by ascending tag: pixels and their meaning, geometry, acquisition,
/// segments, contours, and references between objects. Everything else is removed, private elements included. Elements:
/// DICOM PS3.6. Treatments are those of PS3.15 table E.1-1 (basic profile with the option to clean descriptors) or
/// stricter.
std::span<const KeptElement> kept_elements() noexcept;

/// Null: the element is removed.
const KeptElement* find_kept(std::uint32_t tag) noexcept;

}  // namespace trocar::dicom::detail
