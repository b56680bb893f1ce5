#include "dicom/pacs/detail/rewrite_object.h"

#include <algorithm>
#include <vector>

#include "dicom/pacs/detail/element_writer.h"
#include "dicom/pacs/detail/kept_elements.h"
#include "dicom/pacs/detail/object_files.h"

namespace trocar::dicom::detail {
namespace {

constexpr std::string_view kNameless = "unnamed";

/// An element that every anonymised object has, whatever the original held.
struct AddedElement {
  std::uint32_t tag = 0;
  std::string_view vr;
  std::string value;
};

/// By ascending tag. Attributes of the modules patient and study that may be empty but not missing (PS3.3, C.7), and
/// the statement of the anonymisation (PS3.3, C.12.1 and C.7.1.1).
std::vector<AddedElement> added_elements(const std::string& patient) {
  return {{0x00080020, "DA", ""},      {0x00080030, "TM", ""},
          {0x00080050, "SH", ""},      {0x00080090, "PN", ""},
          {0x00100010, "PN", patient}, {0x00100020, "LO", patient},
          {0x00100030, "DA", ""},      {0x00100040, "CS", ""},
          {0x00120062, "CS", "YES"},   {0x00120063, "LO", "Trocar: only listed elements kept, UIDs replaced"},
          {0x00200010, "SH", ""},      {0x00280303, "CS", "REMOVED"}};
}

/// Copies one object element by element.
class Anonymiser {
 public:
  Anonymiser(const ObjectSummary& summary, const Pseudonyms& pseudonyms, OutputFile& out)
      : summary_(summary), pseudonyms_(pseudonyms), writer_(out) {}

  Status run(const DataSet& original) {
    std::vector<AddedElement> added = added_elements(pseudonyms_.patient(summary_.patient_id));
    std::size_t next = 0;
    const bool is_whole = copy_elements(original.bytes, original.encoding, 0, [&](std::uint32_t tag) {
      for (; next < added.size() && added[next].tag < tag; ++next) add(added[next], original.encoding);
    });
    for (; next < added.size(); ++next) add(added[next], original.encoding);
    if (!is_whole)
      return fail("the PACS sent an object with a damaged sequence", "", "ask its administrator to check this study");
    return {};
  }

 private:
  void add(const AddedElement& element, Encoding encoding) {
    writer_.element(element.tag, element.vr, element.value, encoding);
  }

  /// False: damaged. `before` is called with the tag of each element that stays.
  template <class Before>
  bool copy_elements(std::string_view bytes, Encoding encoding, int depth, Before before) {
    ElementWalk walk(bytes, encoding);
    Element element;
    while (true) {
      const std::size_t begin = walk.at();
      const auto step = walk.next(element);
      if (step != ElementWalk::Step::kElement) return step == ElementWalk::Step::kEnd;
      const KeptElement* kept = find_kept(element.tag);
      if (kept == nullptr) continue;
      before(element.tag);
      const std::string_view vr = encoding.is_implicit ? std::string_view() : bytes.substr(begin + 4, 2);
      const std::string_view value = bytes.substr(element.begin, element.size);
      if (kept->treatment == Treatment::kSequence) {
        if (!copy_sequence(element, vr, value, encoding, depth)) return false;
      } else if (element.tag == kPixelData) {
        writer_.bytes(bytes.substr(begin, walk.at() - begin));
      } else if (vr != "SQ" && !element.has_undefined_length) {
        const std::string_view new_vr = kept->treatment == Treatment::kUid ? "UI" : vr;
        writer_.element(element.tag, new_vr, treated(value, kept->treatment), encoding);
      }
    }
  }

  bool copy_sequence(const Element& sequence, std::string_view vr, std::string_view value, Encoding encoding,
                     int depth) {
    if (depth >= kMostNestedSequences) return false;
    if (!encoding.is_implicit && vr != "SQ" && vr != "UN") return true;  // no sequence: removed
    writer_.begin_sequence(sequence.tag, vr, encoding);
    ElementWalk walk(value, sequence.inside);
    Element item;
    auto step = ElementWalk::Step::kEnd;
    while ((step = walk.next_item(item)) == ElementWalk::Step::kElement) {
      writer_.begin_item(encoding);
      const auto ignore = [](std::uint32_t) {};
      if (!copy_elements(value.substr(item.begin, item.size), sequence.inside, depth + 1, ignore)) return false;
      writer_.end_item(encoding);
    }
    writer_.end_sequence(encoding);
    return step == ElementWalk::Step::kEnd;
  }

  std::string_view treated(std::string_view value, Treatment treatment) {
    switch (treatment) {
      case Treatment::kUid:
        return text_ = replaced_uids(value);
      case Treatment::kDescription:
        return text_ = summary_.words.cleaned(trimmed(value), false);
      case Treatment::kLabel:
        text_ = summary_.words.cleaned(trimmed(value), true);
        if (text_.empty() && !trimmed(value).empty()) text_ = kNameless;
        return text_;
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

  /// The UIDs of a value "a\b".
  std::string replaced_uids(std::string_view value) const {
    std::string result;
    for (std::size_t begin = 0; begin <= value.size();) {
      const std::size_t end = std::min(value.find('\\', begin), value.size());
      const std::string_view uid = trimmed(value.substr(begin, end - begin));
      if (begin > 0) result += '\\';
      if (!uid.empty()) result += pseudonyms_.uid(uid);
      begin = end + 1;
    }
    return result;
  }

  const ObjectSummary& summary_;
  const Pseudonyms& pseudonyms_;
  ElementWriter writer_;
  std::string text_;  ///< The value that treated() returned last.
};

}  // namespace

Status write_anonymised(const DataSet& original, const ObjectSummary& summary, const Pseudonyms& pseudonyms,
                        const std::filesystem::path& path) {
  OutputFile out(path);
  write_meta({summary.sop_class, pseudonyms.uid(summary.sop_instance), original.transfer_syntax}, out);
  TROCAR_TRY_STATUS(Anonymiser(summary, pseudonyms, out).run(original));
  return out.close();
}

Status write_unchanged(const DataSet& original, const ObjectSummary& summary, const std::filesystem::path& path) {
  OutputFile out(path);
  write_meta({summary.sop_class, summary.sop_instance, original.transfer_syntax}, out);
  out.write(original.bytes);
  return out.close();
}

}  // namespace trocar::dicom::detail
