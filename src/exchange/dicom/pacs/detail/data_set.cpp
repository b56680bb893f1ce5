#include "dicom/pacs/detail/data_set.h"

#include <algorithm>
#include <map>

#include "core/text.h"
#include "dicom/elements/dicom_file.h"
#include "dicom/pacs/detail/anonymisation.h"
#include "dicom/pacs/detail/element_writer.h"

namespace trocar::dicom::detail {
namespace {

constexpr std::string_view kMark = "DICM";
constexpr std::size_t kMaxNameBytes = 4096;  ///< A longer value is no name and no UID.
constexpr const char* kAskAdministrator = "ask the administrator of the PACS to check this study";

constexpr std::uint32_t kImageType = tag(0x0008, 0x0008);
constexpr std::uint32_t kBurnedIn = tag(0x0028, 0x0301);

/// Kinds of images whose pixels usually contain the patient's name.
bool usually_shows_text(std::string_view modality) {
  return modality == "US" || modality == "SC" || modality == "OT" || modality == "XC" || modality == "ES";
}

tl::unexpected<Error> damaged() {
  return fail("the PACS sent an object that is damaged or ends too early", "", kAskAdministrator);
}

}  // namespace

std::string_view trimmed(std::string_view value) noexcept {
  constexpr std::string_view kPadding(" \0", 2);
  const auto first = value.find_first_not_of(kPadding);
  if (first == std::string_view::npos) return {};
  return value.substr(first, value.find_last_not_of(kPadding) + 1 - first);
}

Result<Encoding> encoding_of(std::string_view transfer_syntax) {
  if (transfer_syntax == kDeflated)
    return fail("the PACS sent a deflated object", "", "ask its administrator to send uncompressed or JPEG objects");
  return Encoding{transfer_syntax == kExplicitBig, transfer_syntax == kImplicitLittle};
}

Result<DataSet> find_data_set(std::string_view object, const std::string& transfer_syntax) {
  DataSet found{object, {}, transfer_syntax};
  if (transfer_syntax.empty()) {
    if (object.size() < kPreamble + kMark.size() || object.substr(kPreamble, kMark.size()) != kMark)
      return fail("the PACS sent an object that is not DICOM", "", kAskAdministrator);
    ElementWalk meta(object, Encoding{}, kPreamble + kMark.size());
    Element element;
    while (meta.next_group() == 0x0002 && meta.next(element) == ElementWalk::Step::kElement)
      if (element.tag == kTransferSyntax && element.size <= kMaxNameBytes)
        found.transfer_syntax = trimmed(object.substr(element.begin, element.size));
    found.bytes = object.substr(meta.at());
  }
  if (!is_uid(found.transfer_syntax)) return damaged();
  TROCAR_TRY(found.encoding, encoding_of(found.transfer_syntax));
  return found;
}

Result<ObjectSummary> summarize(const DataSet& data_set) {
  ObjectSummary summary;
  std::string burned_in, image_type;
  const auto keep = [&](std::uint32_t tag, std::string_view text) {
    if (tag == kCharacterSet) summary.repertoire = repertoire_of(text);
    if (is_name_of_person(tag)) summary.names.add(text, summary.repertoire);
    if (tag == 0x00080016) summary.sop_class = text;
    if (tag == 0x00080018) summary.sop_instance = text;
    if (tag == 0x0020000d) summary.study = text;
    if (tag == 0x0020000e) summary.series = text;
    if (tag == 0x00100020) summary.patient_id = text;
    if (tag == 0x00080060) summary.modality = text;
    if (tag == 0x00200013) summary.instance_number = parse_number<int>(text);
    if (tag == kBurnedIn) burned_in = text;
    if (tag == kImageType) image_type = text;
  };
  ElementWalk walk(data_set.bytes, data_set.encoding);
  Element element;
  auto step = ElementWalk::Step::kEnd;
  while ((step = walk.next(element)) == ElementWalk::Step::kElement)
    if (element.size <= kMaxNameBytes) keep(element.tag, trimmed(data_set.bytes.substr(element.begin, element.size)));
  if (step == ElementWalk::Step::kDamaged) return damaged();
  for (const std::string* uid : {&summary.sop_class, &summary.sop_instance, &summary.study, &summary.series})
    if (!is_uid(*uid)) return damaged();
  summary.may_show_text = burned_in == "YES" || (burned_in != "NO" && usually_shows_text(summary.modality)) ||
                          (burned_in != "NO" && image_type.find("SCREEN SAVE") != std::string::npos);
  return summary;
}

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
