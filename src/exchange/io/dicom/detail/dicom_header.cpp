#include "io/dicom/detail/dicom_header.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <string_view>

#include "core/files/input_file.h"

namespace trocar::io::detail {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kPreamble = 128;
constexpr std::size_t kMaxKept = 4096;  ///< Longer elements are not header text.
constexpr std::size_t kMaxFragments = 1 << 16;
constexpr std::uint32_t kUndefined = 0xffffffff;
constexpr int kMaxDepth = 32;
constexpr std::uint32_t kItem = dicom_tag(0xfffe, 0xe000);
constexpr std::uint32_t kItemEnd = dicom_tag(0xfffe, 0xe00d);
constexpr std::uint32_t kSequenceEnd = dicom_tag(0xfffe, 0xe0dd);
constexpr std::uint32_t kPixelData = dicom_tag(0x7fe0, 0x0010);

// DICOM PS3.5, annex A.
constexpr std::string_view kImplicitLittle = "1.2.840.10008.1.2";
constexpr std::string_view kExplicitBig = "1.2.840.10008.1.2.2";
constexpr std::string_view kDeflated = "1.2.840.10008.1.2.1.99";

bool is_vr(std::string_view vr) {
  return vr.size() == 2 && std::isupper(static_cast<unsigned char>(vr[0])) != 0 &&
         std::isupper(static_cast<unsigned char>(vr[1])) != 0;
}

bool is_kept(std::uint32_t tag) {
  return std::ranges::find(dicom_tags::kAll, tag) != dicom_tags::kAll.end();
}

/// Value representations with a 32-bit length.
bool is_long_vr(std::string_view vr) {
  constexpr std::array<std::string_view, 13> kLong = {"OB", "OW", "OF", "OD", "OL", "OV", "SQ",
                                                      "UC", "UR", "UT", "UN", "SV", "UV"};
  return std::find(kLong.begin(), kLong.end(), vr) != kLong.end();
}

/// The first bytes identify a DICOM file: with its prefix, or starting directly with group 2 or 8.
bool may_be_dicom(const InputFile& input) {
  std::array<char, kPreamble + 4> start{};
  std::ifstream file(input.pinned_path(), std::ios::binary);
  file.read(start.data(), start.size());
  const auto count = static_cast<std::size_t>(file.gcount());
  if (count == start.size() && std::string_view(start.data() + kPreamble, 4) == "DICM") return true;
  const bool is_group = count >= 8 && (start[0] == 2 || start[0] == 8) && start[1] == 0 && start[3] == 0;
  return is_group && (is_vr({start.data() + 4, 2}) || (start[6] == 0 && start[7] == 0));
}

}  // namespace

/// Iterates over the elements of one file; every step returns false if the file ends too early or is not valid.
class DicomWalk {
 public:
  explicit DicomWalk(DicomHeader& header) : header_(header) {}

  bool run() {
    const bool has_mark = header_.bytes_.size() >= kPreamble + 4 && header_.bytes_.compare(kPreamble, 4, "DICM") == 0;
    at_ = has_mark ? kPreamble + 4 : 0;
    if (!walk_elements(Part::kMeta)) return false;
    header_.transfer_syntax_ = header_.text(dicom_tags::kTransferSyntax);
    choose_encoding();
    // A file that GDCM unpacks as a whole is refused later by its transfer syntax.
    return header_.transfer_syntax_ == kDeflated || walk_elements(Part::kDataSet);
  }

 private:
  enum class Part { kMeta, kDataSet };
  struct Element {
    std::uint32_t tag = 0;
    std::uint32_t length = 0;
  };

  std::size_t left() const { return header_.bytes_.size() - at_; }

  std::uint32_t peek(std::size_t offset, int bytes) const {
    std::uint32_t value = 0;
    for (int n = 0; n < bytes; ++n) {
      const auto byte = static_cast<unsigned char>(header_.bytes_[at_ + offset + static_cast<std::size_t>(n)]);
      value |= static_cast<std::uint32_t>(byte) << 8 * (is_big_ ? bytes - 1 - n : n);
    }
    return value;
  }

  void choose_encoding() {
    const std::string& syntax = header_.transfer_syntax_;
    is_big_ = header_.is_big_endian_ = syntax == kExplicitBig;
    is_implicit_ = syntax == kImplicitLittle;
    if (syntax.empty()) is_implicit_ = left() >= 6 && !is_vr({header_.bytes_.data() + at_ + 4, 2});
  }

  bool read_element(Element& element, bool is_implicit) {
    if (left() < 8) return false;
    element.tag = dicom_tag(static_cast<std::uint16_t>(peek(0, 2)), static_cast<std::uint16_t>(peek(2, 2)));
    if (is_implicit || element.tag >> 16 == 0xfffe) {
      element.length = peek(4, 4);
      at_ += 8;
      return true;
    }
    const std::string_view vr(header_.bytes_.data() + at_ + 4, 2);
    if (!is_vr(vr)) return false;
    if (!is_long_vr(vr)) {
      element.length = peek(6, 2);
      at_ += 8;
      return true;
    }
    if (left() < 12) return false;
    element.length = peek(8, 4);
    // An unknown value of undefined length is encoded like an implicit one (PS3.5, 6.2.2).
    is_unknown_ = vr == "UN";
    at_ += 12;
    return true;
  }

  bool skip(std::uint32_t length) {
    if (length > left()) return false;
    at_ += length;
    return true;
  }

  /// Elements of the top level: those of group 2, or all others up to the pixels.
  bool walk_elements(Part part) {
    while (left() > 0) {
      if (left() < 8) return true;  // Some writers pad the end.
      if (part == Part::kMeta && peek(0, 2) != 0x0002) return true;
      is_unknown_ = false;
      Element element;
      if (!read_element(element, is_implicit_)) return false;
      if (element.tag == kPixelData) return take_pixels(element.length);
      if (element.length == kUndefined) {
        if (!skip_sequence(is_implicit_ || is_unknown_, 0)) return false;
        continue;
      }
      if (element.length <= kMaxKept && is_kept(element.tag)) header_.elements_[element.tag] = {at_, element.length};
      if (!skip(element.length)) return false;
    }
    return true;
  }

  bool skip_sequence(bool is_implicit, int depth) {
    if (depth > kMaxDepth) return false;
    while (true) {
      Element item;
      if (!read_element(item, true)) return false;
      if (item.tag == kSequenceEnd) return true;
      if (item.tag != kItem) return false;
      if (!(item.length == kUndefined ? skip_item(is_implicit, depth) : skip(item.length))) return false;
    }
  }

  bool skip_item(bool is_implicit, int depth) {
    while (true) {
      is_unknown_ = false;
      Element element;
      if (!read_element(element, is_implicit)) return false;
      if (element.tag == kItemEnd) return true;
      const bool is_done =
          element.length == kUndefined ? skip_sequence(is_implicit || is_unknown_, depth + 1) : skip(element.length);
      if (!is_done) return false;
    }
  }

  bool take_pixels(std::uint32_t length) {
    if (length != kUndefined) {
      header_.pixels_.push_back({at_, length});
      return skip(length);
    }
    header_.is_compressed_ = true;
    for (bool is_offset_table = true;; is_offset_table = false) {
      Element item;
      if (!read_element(item, true)) return false;
      if (item.tag == kSequenceEnd) return true;
      if (item.tag != kItem || item.length == kUndefined) return false;
      if (header_.pixels_.size() == kMaxFragments) return false;
      if (!is_offset_table) header_.pixels_.push_back({at_, item.length});
      if (!skip(item.length)) return false;
    }
  }

  DicomHeader& header_;
  std::size_t at_ = 0;
  bool is_big_ = false;
  bool is_implicit_ = false;
  bool is_unknown_ = false;
};

Result<std::optional<DicomHeader>> DicomHeader::read(const fs::path& path) {
  TROCAR_TRY(const InputFile file, InputFile::open(path, FileKind::kDicom));
  if (!may_be_dicom(file)) return std::optional<DicomHeader>();
  DicomHeader header;
  TROCAR_TRY(header.bytes_, file.read_all());
  if (!DicomWalk(header).run())
    return fail("the DICOM file is damaged or ends too early", path.string(), "copy or export it again");
  return std::optional(std::move(header));
}

std::string DicomHeader::text(std::uint32_t tag) const {
  const auto found = elements_.find(tag);
  if (found == elements_.end()) return {};
  std::string text = bytes_.substr(found->second.begin, found->second.size);
  const auto last = text.find_last_not_of(std::string_view(" \0", 2));
  text.resize(last == std::string::npos ? 0 : last + 1);
  return text;
}

std::optional<int> DicomHeader::number(std::uint32_t tag) const {
  const auto found = elements_.find(tag);
  if (found == elements_.end() || found->second.size < 2) return std::nullopt;
  const auto first = static_cast<unsigned char>(bytes_[found->second.begin]);
  const auto second = static_cast<unsigned char>(bytes_[found->second.begin + 1]);
  return is_big_endian_ ? first << 8 | second : second << 8 | first;
}

std::vector<std::span<const char>> DicomHeader::pixels() const {
  std::vector<std::span<const char>> pieces;
  for (const Range& range : pixels_) pieces.emplace_back(bytes_.data() + range.begin, range.size);
  return pieces;
}

}  // namespace trocar::io::detail
