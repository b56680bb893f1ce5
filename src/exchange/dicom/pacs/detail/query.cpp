#include "dicom/pacs/detail/query.h"

#include <algorithm>
#include <map>

#include "core/parse_number.h"
#include "core/utf8.h"
#include "dicom/pacs/detail/element_writer.h"

namespace trocar::dicom::detail {
namespace {

constexpr std::uint32_t kStudyDate = tag(0x0008, 0x0020);
constexpr std::uint32_t kLevel = tag(0x0008, 0x0052);
constexpr std::uint32_t kModality = tag(0x0008, 0x0060);
constexpr std::uint32_t kModalities = tag(0x0008, 0x0061);
constexpr std::uint32_t kStudyDescription = tag(0x0008, 0x1030);
constexpr std::uint32_t kSeriesDescription = tag(0x0008, 0x103e);
constexpr std::uint32_t kPatientId = tag(0x0010, 0x0020);
constexpr std::uint32_t kStudyUid = tag(0x0020, 0x000d);
constexpr std::uint32_t kSeriesNumber = tag(0x0020, 0x0011);
constexpr std::uint32_t kImagesOfSeries = tag(0x0020, 0x1209);
constexpr std::size_t kMaxAnswerText = 1024;

/// Texts of the top level by tag.
std::map<std::uint32_t, std::string> texts_of(const DataSet& answer) {
  std::map<std::uint32_t, std::string> texts;
  ElementWalk walk(answer.bytes, answer.encoding);
  Element element;
  while (walk.next(element) == ElementWalk::Step::kElement)
    if (element.size <= kMaxAnswerText && texts.size() < kMaxAnswerText)
      texts[element.tag] = trimmed(answer.bytes.substr(element.begin, element.size));
  return texts;
}

}  // namespace

std::string study_query(const std::string& patient_id, Encoding encoding) {
  return encoded_element(kStudyDate, "DA", "", encoding) + encoded_element(kLevel, "CS", "STUDY", encoding) +
         encoded_element(kModalities, "CS", "", encoding) + encoded_element(kStudyDescription, "LO", "", encoding) +
         encoded_element(kPatientId, "LO", patient_id, encoding) + encoded_element(kStudyUid, "UI", "", encoding);
}

std::string series_query(const std::string& study_uid, Encoding encoding) {
  return encoded_element(kLevel, "CS", "SERIES", encoding) + encoded_element(kModality, "CS", "", encoding) +
         encoded_element(kSeriesDescription, "LO", "", encoding) +
         encoded_element(kStudyUid, "UI", study_uid, encoding) + encoded_element(kSeriesUid, "UI", "", encoding) +
         encoded_element(kSeriesNumber, "IS", "", encoding) + encoded_element(kImagesOfSeries, "IS", "", encoding);
}

std::string retrieve_query(const std::string& study_uid, const std::string& series_uid, Encoding encoding) {
  return encoded_element(kLevel, "CS", "SERIES", encoding) + encoded_element(kStudyUid, "UI", study_uid, encoding) +
         encoded_element(kSeriesUid, "UI", series_uid, encoding);
}

StudyEntry study_of(const DataSet& answer) {
  auto texts = texts_of(answer);
  return {texts[kStudyUid], shown_text(texts[kStudyDate]), shown_text(texts[kStudyDescription]),
          shown_text(texts[kModalities])};
}

SeriesEntry series_of(const DataSet& answer) {
  auto texts = texts_of(answer);
  return {texts[kSeriesUid], shown_text(texts[kModality]), shown_text(texts[kSeriesDescription]),
          parse_number<int>(texts[kSeriesNumber]), parse_number<std::size_t>(texts[kImagesOfSeries])};
}

std::string shown_text(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const auto character = first_character(text);
    const auto byte = static_cast<unsigned char>(text.front());
    if (character) {
      // Control characters of both sets could change the terminal.
      const bool is_control =
          character->code_point < 0x20 || (character->code_point >= 0x7f && character->code_point < 0xa0);
      result += is_control ? std::string(" ") : std::string(text.substr(0, character->bytes));
    } else if (byte >= 0xa0) {  // ISO 8859-1
      result += static_cast<char>(0xc0 | byte >> 6);
      result += static_cast<char>(0x80 | (byte & 0x3f));
    } else {
      result += ' ';
    }
    text.remove_prefix(character ? character->bytes : 1);
  }
  return result;
}

}  // namespace trocar::dicom::detail
