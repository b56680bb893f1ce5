#pragma once

#include <string>
#include <string_view>

#include "dicom/pacs/detail/anonymisation.h"
#include "dicom/pacs/detail/kept_elements.h"

namespace trocar::dicom::detail {

/// What the treatment of a value depends on beside the value.
struct ValueContext {
  Repertoire repertoire = Repertoire::kAscii;  ///< Of the item.
  std::string_view coding_scheme;              ///< Of the item; empty: none.
  const IdentityWords* names = nullptr;        ///< Of the object.
};

/// The value as an anonymised object has it; `value` without padding where it is text. The result may be a view of
/// `value`. Not for sequences.
class ValueTreatment {
 public:
  explicit ValueTreatment(Anonymisation& rules) noexcept : rules_(rules) {}

  /// Valid until the next call.
  std::string_view operator()(std::string_view value, Treatment treatment, const ValueContext& context);

 private:
  std::string replaced_uids(std::string_view value) const;
  std::string replaced_texts(std::string_view value, Treatment treatment, const ValueContext& context);
  std::string replaced_codes(std::string_view value);
  std::string_view checked_numbers(std::string_view value);
  std::string_view checked_character_sets(std::string_view value);
  std::string_view checked_code_value(std::string_view value, const ValueContext& context);

  Anonymisation& rules_;
  std::string text_;  ///< The value that was returned last, if it is a new one.
};

/// True for a value representation whose values are characters. Elements of numbers are removed if they have it.
bool has_characters(std::string_view vr) noexcept;
/// True if a value that should be binary numbers consists of letters, digits and what stands between them: an object
/// can name any VR, "UN" or none.
bool is_text(std::string_view value, std::string_view vr) noexcept;

}  // namespace trocar::dicom::detail
