#include "dicom/pacs/detail/rewrite_object.h"

#include <algorithm>
#include <array>
#include <vector>

#include "dicom/elements/element_walk.h"
#include "dicom/pacs/detail/element_writer.h"
#include "dicom/pacs/detail/kept_elements.h"
#include "dicom/pacs/detail/object_files.h"
#include "dicom/pacs/detail/value_treatment.h"

namespace trocar::dicom::detail {
namespace {

constexpr std::uint32_t kCodingSchemeDesignator = 0x00080102;

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

/// What an item says about its own texts and codes. It has the character set of `outer` unless it names another.
ValueContext context_of(std::string_view item, Encoding encoding, const ValueContext& outer) {
  ValueContext context{outer.repertoire, {}, outer.names};
  constexpr std::uint32_t kGroupOfBoth = 0x0008;
  ElementWalk walk(item, encoding);
  Element element;
  while (walk.next_group() <= kGroupOfBoth && walk.next(element) == ElementWalk::Step::kElement) {
    const std::string_view value = trimmed(item.substr(element.begin, element.size));
    if (element.tag == kCharacterSet) context.repertoire = repertoire_of(value);
    if (element.tag == kCodingSchemeDesignator) context.coding_scheme = value;
  }
  return context;
}

/// Copies one object element by element.
class Anonymiser {
 public:
  Anonymiser(const ObjectSummary& summary, Anonymisation& rules, OutputFile& out)
      : summary_(summary), rules_(rules), treated_(rules), writer_(out) {}

  Status run(const DataSet& original) {
    std::vector<AddedElement> added = added_elements(rules_.pseudonyms.patient(summary_.patient_id));
    std::size_t next = 0;
    const ValueContext outer{summary_.repertoire, {}, &summary_.names};
    const bool is_whole = copy_elements(original.bytes, original.encoding, 0, outer, [&](std::uint32_t tag) {
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
  bool copy_elements(std::string_view bytes, Encoding encoding, int depth, const ValueContext& outer, Before before) {
    const ValueContext context = context_of(bytes, encoding, outer);
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
        if (!copy_sequence(element, vr, value, encoding, depth, context)) return false;
      } else if (element.tag == kPixelData) {
        writer_.bytes(bytes.substr(begin, walk.at() - begin));
      } else if (vr != "SQ" && !element.has_undefined_length &&
                 (kept->treatment != Treatment::kKeep || (!has_characters(vr) && !is_text(value, vr)))) {
        const std::string_view new_vr = kept->treatment == Treatment::kUid ? "UI" : vr;
        writer_.element(element.tag, new_vr, treated_(value, kept->treatment, context), encoding);
      }
    }
  }

  bool copy_sequence(const Element& sequence, std::string_view vr, std::string_view value, Encoding encoding, int depth,
                     const ValueContext& outer) {
    if (depth >= kMostNestedSequences) return false;
    if (!encoding.is_implicit && vr != "SQ" && vr != "UN") return true;  // no sequence: removed
    writer_.begin_sequence(sequence.tag, vr, encoding);
    ElementWalk walk(value, sequence.inside);
    Element item;
    auto step = ElementWalk::Step::kEnd;
    while ((step = walk.next_item(item)) == ElementWalk::Step::kElement) {
      writer_.begin_item(encoding);
      const auto ignore = [](std::uint32_t) {};
      if (!copy_elements(value.substr(item.begin, item.size), sequence.inside, depth + 1, outer, ignore)) return false;
      writer_.end_item(encoding);
    }
    writer_.end_sequence(encoding);
    return step == ElementWalk::Step::kEnd;
  }

  const ObjectSummary& summary_;
  Anonymisation& rules_;
  ValueTreatment treated_;
  ElementWriter writer_;
};

}  // namespace

Status write_anonymised(const DataSet& original, const ObjectSummary& summary, Anonymisation& rules,
                        const std::filesystem::path& path) {
  OutputFile out(path);
  write_meta({summary.sop_class, rules.pseudonyms.uid(summary.sop_instance), original.transfer_syntax}, out);
  TROCAR_TRY_STATUS(Anonymiser(summary, rules, out).run(original));
  return out.close();
}

Status write_unchanged(const DataSet& original, const ObjectSummary& summary, const std::filesystem::path& path) {
  OutputFile out(path);
  write_meta({summary.sop_class, summary.sop_instance, original.transfer_syntax}, out);
  out.write(original.bytes);
  return out.close();
}

namespace {

constexpr std::string_view kStorage = "1.2.840.10008.5.1.4.1.1.";
constexpr const char* kExplicitLittle = "1.2.840.10008.1.2.1";

// PS3.6, annex A.
constexpr auto kClasses = std::to_array<std::string_view>({
    "1.2.840.10008.5.1.4.1.1.1",      // computed radiography
    "1.2.840.10008.5.1.4.1.1.1.1",    // digital radiography
    "1.2.840.10008.5.1.4.1.1.2",      // CT
    "1.2.840.10008.5.1.4.1.1.2.1",    // enhanced CT
    "1.2.840.10008.5.1.4.1.1.2.2",    // legacy converted enhanced CT
    "1.2.840.10008.5.1.4.1.1.3.1",    // ultrasound, several frames
    "1.2.840.10008.5.1.4.1.1.4",      // MR
    "1.2.840.10008.5.1.4.1.1.4.1",    // enhanced MR
    "1.2.840.10008.5.1.4.1.1.6.1",    // ultrasound
    "1.2.840.10008.5.1.4.1.1.7",      // secondary capture
    "1.2.840.10008.5.1.4.1.1.12.1",   // X-ray angiography
    "1.2.840.10008.5.1.4.1.1.12.2",   // fluoroscopy
    "1.2.840.10008.5.1.4.1.1.20",     // nuclear medicine
    "1.2.840.10008.5.1.4.1.1.66.4",   // segmentation
    "1.2.840.10008.5.1.4.1.1.66.7",   // label map
    "1.2.840.10008.5.1.4.1.1.128",    // PET
    "1.2.840.10008.5.1.4.1.1.481.3",  // structure set
});

constexpr auto kOftenCompressed = std::to_array<std::string_view>({
    "1.2.840.10008.5.1.4.1.1.2",
    "1.2.840.10008.5.1.4.1.1.2.1",
    "1.2.840.10008.5.1.4.1.1.3.1",
    "1.2.840.10008.5.1.4.1.1.4",
    "1.2.840.10008.5.1.4.1.1.4.1",
    "1.2.840.10008.5.1.4.1.1.6.1",
    "1.2.840.10008.5.1.4.1.1.7",
    "1.2.840.10008.5.1.4.1.1.12.1",
    "1.2.840.10008.5.1.4.1.1.66.4",
});

constexpr auto kCompressed = std::to_array<const char*>({
    "1.2.840.10008.1.2.4.70",  // JPEG lossless, first-order prediction
    "1.2.840.10008.1.2.4.57",  // JPEG lossless
    "1.2.840.10008.1.2.4.80",  // JPEG-LS lossless
    "1.2.840.10008.1.2.4.90",  // JPEG 2000 lossless
    "1.2.840.10008.1.2.5",     // run length
    "1.2.840.10008.1.2.4.81",  // JPEG-LS
    "1.2.840.10008.1.2.4.91",  // JPEG 2000
    "1.2.840.10008.1.2.4.51",  // JPEG, 12 bits
    "1.2.840.10008.1.2.4.50",  // JPEG, 8 bits
});

}  // namespace

bool is_storage_class(std::string_view sop_class) noexcept {
  return sop_class.starts_with(kStorage);
}

bool can_anonymise(std::string_view sop_class) noexcept {
  return std::ranges::find(kClasses, sop_class) != kClasses.end();
}

std::string preferred_transfer_syntax(std::span<const std::string> offered) {
  std::vector<std::string_view> order = {kExplicitLittle, kImplicitLittle};
  order.insert(order.end(), kCompressed.begin(), kCompressed.end());
  order.emplace_back("1.2.840.10008.1.2.2");  // big-endian, retired
  for (const std::string_view wanted : order)
    if (std::ranges::find(offered, wanted) != offered.end()) return std::string(wanted);
  return {};
}

std::vector<ContextOffer> storage_offers() {
  std::vector<ContextOffer> offers;
  for (const std::string_view sop_class : kClasses) offers.push_back({sop_class, {kExplicitLittle, kImplicitLittle}});
  for (const std::string_view sop_class : kOftenCompressed)
    for (const char* encoding : kCompressed) offers.push_back({sop_class, {encoding}});
  return offers;
}

}  // namespace trocar::dicom::detail
