#include "dicom/pacs/detail/value_treatment.h"

#include <algorithm>
#include <array>

#include "core/text.h"
#include "dicom/elements/dicom_file.h"
#include "dicom/pacs/detail/data_set.h"

namespace trocar::dicom::detail {
namespace {

using Kind = TextCodes::Kind;

constexpr std::string_view kOther = "OTHER";               ///< In place of a coded value.
constexpr std::string_view kPrivateScheme = "99REPLACED";  ///< "99": no public scheme (PS3.16, 8.2).

constexpr auto kOfCharacters = std::to_array<std::string_view>(
    {"AE", "AS", "CS", "DA", "DS", "DT", "IS", "LO", "LT", "PN", "SH", "ST", "TM", "UC", "UI", "UR", "UT"});

/// Schemes whose codes are published (PS3.16, 8): a code is no text of the hospital.
constexpr auto kPublicSchemes =
    std::to_array<std::string_view>({"SCT", "SRT", "SNM3", "99SDM", "DCM", "FMA", "UCUM", "LN", "RADLEX", "NCIt",
                                     "UMLS", "UBERON", "ACR", "ICDO3", "I10", "MA", "ITIS_TSN", "PUBCHEM_CID"});

bool is_public_scheme(std::string_view scheme) {
  return std::ranges::find(kPublicSchemes, scheme) != kPublicSchemes.end();
}

/// Calls `use` with each value of "a\b", without padding.
template <class Use>
void for_each_value(std::string_view values, Use use) {
  for (std::size_t begin = 0; begin <= values.size();) {
    const std::size_t end = std::min(values.find('\\', begin), values.size());
    use(trimmed(values.substr(begin, end - begin)));
    begin = end + 1;
  }
}

/// "a\b" with each value replaced by what `replace` returns.
template <class Replace>
std::string with_each_value(std::string_view values, Replace replace) {
  std::string result;
  bool is_first = true;
  for_each_value(values, [&](std::string_view value) {
    if (!is_first) result += '\\';
    is_first = false;
    if (!value.empty()) result += replace(value);
  });
  return result;
}

/// "10200004", "T-62000", "RID58", "113076": up to three letters, digits, and the letters of hexadecimal digits.
bool is_code_value_of_a_scheme(std::string_view value) {
  const auto digits = std::ranges::find_if_not(value, ascii::is_upper) - value.begin();
  std::string_view rest = value.substr(static_cast<std::size_t>(std::min<std::ptrdiff_t>(digits, 3)));
  const auto is_allowed = [](char c) { return ascii::is_digit(c) || c == '-' || (c >= 'A' && c <= 'F'); };
  return std::ranges::any_of(rest, ascii::is_digit) && std::ranges::all_of(rest, is_allowed);
}

int number_at(std::string_view digits, std::size_t at, std::size_t count) {
  return parse_number<int>(digits.substr(at, count)).value_or(0);
}

/// Six digits of a day, a month and a year in any usual order.
bool is_date(std::string_view digits) {
  const auto is_day_and_month = [&](std::size_t day, std::size_t month) {
    const int d = number_at(digits, day, 2), m = number_at(digits, month, 2);
    return d >= 1 && d <= 31 && m >= 1 && m <= 12;
  };
  return digits.size() == 6 && (is_day_and_month(0, 2) || is_day_and_month(2, 0) || is_day_and_month(4, 2));
}

/// One number, with a decimal comma, too; no date, and not so many digits as the number of a patient has.
bool is_harmless_number(std::string_view text) {
  std::string number(text);
  std::ranges::replace(number, ',', '.');
  if (decimals_in(number).size() != 1) return false;
  constexpr std::size_t kMostDigits = 6;
  std::string_view digits = number;
  while (!digits.empty() && !ascii::is_digit(digits.front())) digits.remove_prefix(1);
  const auto is_other = [](char c) { return !ascii::is_digit(c); };
  const auto end = std::ranges::find_if(digits, is_other);
  const std::string_view behind(end, digits.end());
  const bool is_whole = behind.find_first_not_of(".0 ") == std::string_view::npos;
  digits = digits.substr(0, static_cast<std::size_t>(end - digits.begin()));
  return digits.size() <= kMostDigits && !(is_whole && is_date(digits));
}

Kind kind_of(Treatment treatment) {
  if (treatment == Treatment::kSeries) return Kind::kSeries;
  return treatment == Treatment::kStructure ? Kind::kStructure : Kind::kOther;
}

}  // namespace

bool has_characters(std::string_view vr) noexcept {
  return std::ranges::find(kOfCharacters, vr) != kOfCharacters.end();
}

bool is_text(std::string_view value, std::string_view vr) noexcept {
  // Numbers of eight bytes have others among them: the last is @ or ? from 0.00003 to 65,536.
  constexpr std::size_t kShortest = 6;
  constexpr std::string_view kOfNames(" .,^'-/:_=()");
  const bool has_any_vr = vr == "UN";
  const auto is_of_text = [&](char c) {
    return ascii::is_letter_or_digit(c) || kOfNames.find(c) != std::string_view::npos ||
           (has_any_vr && static_cast<unsigned char>(c) >= 0x80);
  };
  const std::string_view text = trimmed(value);
  return text.size() >= kShortest && std::ranges::all_of(text, is_of_text);
}

std::string_view ValueTreatment::operator()(std::string_view value, Treatment treatment, const ValueContext& context) {
  switch (treatment) {
    case Treatment::kUid:
      return text_ = with_each_value(value, [&](std::string_view uid) { return rules_.pseudonyms.uid(uid); });
    case Treatment::kSeries:
    case Treatment::kStructure:
    case Treatment::kText:
      return text_ = replaced_texts(value, treatment, context);
    case Treatment::kCode:
      return text_ = replaced_codes(value);
    case Treatment::kCodeValue:
      return checked_code_value(trimmed(value), context);
    case Treatment::kCodingScheme:
      return trimmed(value).empty() || is_public_scheme(trimmed(value)) ? value : kPrivateScheme;
    case Treatment::kCharacters:
      return checked_character_sets(value);
    case Treatment::kNumber:
      return checked_numbers(value);
    case Treatment::kEmpty:
      return {};
    case Treatment::kDate:
      return "20000101";
    case Treatment::kTime:
      return "000000";
    case Treatment::kKeep:
    case Treatment::kSequence:
      break;
  }
  return value;
}

std::string ValueTreatment::replaced_texts(std::string_view value, Treatment treatment, const ValueContext& context) {
  static const IdentityWords kNoNames;
  const TextUse use = treatment == Treatment::kStructure ? TextUse::kStructure : TextUse::kDescription;
  const IdentityWords& names = context.names == nullptr ? kNoNames : *context.names;
  return with_each_value(value, [&](std::string_view text) {
    const bool stays = rules_.words.is_harmless(text, context.repertoire, use, names);
    return stays ? std::string(text) : rules_.codes.code_of(kind_of(treatment), text);
  });
}

std::string ValueTreatment::replaced_codes(std::string_view value) {
  return with_each_value(value, [&](std::string_view code) {
    if (rules_.words.is_harmless_code(code)) return code;
    rules_.codes.add_removed(code);
    return kOther;
  });
}

std::string_view ValueTreatment::checked_code_value(std::string_view value, const ValueContext& context) {
  const bool is_public =
      is_public_scheme(context.coding_scheme) &&
      (is_code_value_of_a_scheme(value) || context.coding_scheme == "UCUM" || rules_.words.is_harmless_code(value));
  if (value.empty() || is_public) return value;
  return text_ = rules_.codes.code_of(Kind::kOther, value);
}

std::string_view ValueTreatment::checked_numbers(std::string_view value) {
  bool are_numbers = true;
  for_each_value(value, [&](std::string_view number) { are_numbers &= number.empty() || is_harmless_number(number); });
  if (are_numbers) return value;
  rules_.codes.add_removed(value);
  return {};
}

std::string_view ValueTreatment::checked_character_sets(std::string_view value) {
  bool are_known = true;
  for_each_value(value, [&](std::string_view name) { are_known &= name.empty() || is_character_set(name); });
  return are_known ? value : std::string_view();
}

}  // namespace trocar::dicom::detail
