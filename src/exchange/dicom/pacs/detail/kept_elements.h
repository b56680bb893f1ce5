#pragma once

#include <cstdint>
#include <span>

namespace trocar::dicom::detail {

/// How the anonymisation treats an element that stays.
enum class Treatment {
  kKeep,         ///< Unchanged.
  kSequence,     ///< Its items are treated element by element.
  kUid,          ///< Replaced, unless DICOM itself defines it.
  kDescription,  ///< Free text: words that identify the patient are removed.
  kLabel,        ///< The same for the name of a structure: words of anatomy stay, and it does not become empty.
  kEmpty,        ///< The element stays, its value is removed.
  kDate,         ///< The element must have a value: 1 January 2000.
  kTime,         ///< The element must have a value: midnight.
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
