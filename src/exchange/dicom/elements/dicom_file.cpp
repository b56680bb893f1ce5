#include "dicom/elements/dicom_file.h"

#include <algorithm>
#include <array>
#include <fstream>

#include "core/files/input_file.h"
#include "core/text.h"

namespace trocar::dicom {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxFragments = 1 << 16;
constexpr std::size_t kMaxItems = 1 << 20;

/// The first bytes identify a DICOM file: with its prefix, or starting directly with group 2 or 8.
bool may_be_dicom(const InputFile& input) {
  std::array<char, kPreamble + 4> start{};
  std::ifstream file(input.pinned_path(), std::ios::binary);
  file.read(start.data(), start.size());
  const auto count = static_cast<std::size_t>(file.gcount());
  if (count == start.size() && std::string_view(start.data() + kPreamble, 4) == "DICM") return true;
  const bool is_group = count >= 8 && (start[0] == 2 || start[0] == 8) && start[1] == 0 && start[3] == 0;
  return is_group && (is_value_representation({start.data() + 4, 2}) || (start[6] == 0 && start[7] == 0));
}

/// Number of bytes of the UTF-8 character at the start of the text; 0 if there is none.
std::size_t utf8_size(std::string_view text) noexcept {
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t size = first < 0x80 ? 1 : first >= 0xc2 && first < 0xe0 ? 2 : first >= 0xe0 && first < 0xf0 ? 3 : 0;
  if (size == 0 || size > text.size()) return 0;
  for (std::size_t n = 1; n < size; ++n)
    if ((static_cast<unsigned char>(text[n]) & 0xc0) != 0x80) return 0;
  return size;
}

}  // namespace

std::string_view without_padding(std::string_view text) noexcept {
  const auto last = text.find_last_not_of(std::string_view(" \0", 2));
  return text.substr(0, last == std::string_view::npos ? 0 : last + 1);
}

std::optional<int> unsigned_short(std::string_view value, bool is_big_endian) noexcept {
  if (value.size() < 2) return std::nullopt;
  const auto first = static_cast<unsigned char>(value[0]);
  const auto second = static_cast<unsigned char>(value[1]);
  return is_big_endian ? first << 8 | second : second << 8 | first;
}

std::optional<Element> DicomItem::find(std::uint32_t tag) const noexcept {
  ElementWalk walk(bytes_, encoding_);
  Element element;
  while (walk.next(element) == ElementWalk::Step::kElement)
    if (element.tag == tag) return element;
  return std::nullopt;
}

std::string_view DicomItem::text(std::uint32_t tag) const noexcept {
  const auto element = find(tag);
  return element ? without_padding(bytes_.substr(element->begin, element->size)) : std::string_view();
}

std::optional<int> DicomItem::number(std::uint32_t tag) const noexcept {
  const auto element = find(tag);
  if (!element) return std::nullopt;
  return unsigned_short(bytes_.substr(element->begin, element->size), encoding_.is_big_endian);
}

std::vector<double> decimals_in(std::string_view text) {
  std::vector<double> numbers;
  std::string_view rest = text;
  while (!rest.empty()) {
    rest.remove_prefix(std::min(rest.find_first_not_of(" +"), rest.size()));
    const auto found = find_leading_number<double>(rest);
    if (!found) return {};
    numbers.push_back(found->value);
    rest = found->rest;
    rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
    if (rest.empty()) break;
    if (rest.front() != '\\') return {};
    rest.remove_prefix(1);
  }
  return numbers;
}

std::vector<double> DicomItem::decimals(std::uint32_t tag) const {
  return decimals_in(text(tag));
}

Result<std::vector<DicomItem>> DicomItem::items(std::uint32_t tag) const {
  std::vector<DicomItem> found;
  const auto element = find(tag);
  if (!element) return found;
  ElementWalk walk(bytes_.substr(0, element->begin + element->size), element->inside, element->begin);
  Element item;
  for (auto step = walk.next_item(item); step != ElementWalk::Step::kEnd; step = walk.next_item(item)) {
    if (step == ElementWalk::Step::kDamaged || found.size() == kMaxItems)
      return fail("the DICOM file is damaged: a sequence cannot be read", {}, "copy or export it again");
    found.emplace_back(bytes_.substr(item.begin, item.size), item.inside);
  }
  return found;
}

std::optional<DicomItem> DicomItem::first_item(std::uint32_t tag) const noexcept {
  const auto element = find(tag);
  if (!element) return std::nullopt;
  ElementWalk walk(bytes_.substr(0, element->begin + element->size), element->inside, element->begin);
  Element item;
  if (walk.next_item(item) != ElementWalk::Step::kElement) return std::nullopt;
  return DicomItem(bytes_.substr(item.begin, item.size), item.inside);
}

Result<std::optional<DicomFile>> DicomFile::read(const fs::path& path) {
  TROCAR_TRY(const InputFile input, InputFile::open(path, FileKind::kDicom));
  if (!may_be_dicom(input)) return std::optional<DicomFile>();
  DicomFile file;
  TROCAR_TRY(file.bytes_, input.read_all());
  if (!file.parse())
    return fail("the DICOM file is damaged or ends too early", path.string(), "copy or export it again");
  return std::optional(std::move(file));
}

bool DicomFile::is_deflated() const noexcept {
  return transfer_syntax_ == kDeflated;
}

bool DicomFile::parse() {
  const bool has_mark = bytes_.size() >= kPreamble + 4 && bytes_.compare(kPreamble, 4, "DICM") == 0;
  data_set_begin_ = has_mark ? kPreamble + 4 : 0;
  Element element;
  ElementWalk meta(bytes_, {}, data_set_begin_);
  while (meta.next_group() == 0x0002) {
    if (meta.next(element) != ElementWalk::Step::kElement) return false;
    if (element.tag == kTransferSyntax)
      transfer_syntax_ = without_padding(std::string_view(bytes_).substr(element.begin, element.size));
  }
  data_set_begin_ = data_set_end_ = meta.at();
  if (is_deflated()) return true;
  encoding_.is_big_endian = transfer_syntax_ == kExplicitBig;
  encoding_.is_implicit = transfer_syntax_ == kImplicitLittle;
  if (transfer_syntax_.empty() && bytes_.size() - data_set_begin_ >= 6)
    encoding_.is_implicit = !is_value_representation({bytes_.data() + data_set_begin_ + 4, 2});
  ElementWalk walk(bytes_, encoding_, data_set_begin_);
  while (true) {
    const ElementWalk::Step step = walk.next(element);
    if (step == ElementWalk::Step::kDamaged) return false;
    if (step == ElementWalk::Step::kEnd) break;
    if (element.tag != kPixelData) continue;
    data_set_end_ = walk.at();
    is_compressed_ = element.has_undefined_length;
    if (is_compressed_) return take_fragments(element);
    pixels_ = {element};
    return true;
  }
  data_set_end_ = walk.at();
  return true;
}

bool DicomFile::take_fragments(const Element& pixels) {
  ElementWalk walk(std::string_view(bytes_).substr(0, pixels.begin + pixels.size), encoding_, pixels.begin);
  Element fragment;
  for (bool is_offset_table = true;; is_offset_table = false) {
    const ElementWalk::Step step = walk.next_item(fragment);
    if (step == ElementWalk::Step::kEnd) return true;
    if (step == ElementWalk::Step::kDamaged || fragment.has_undefined_length) return false;
    if (pixels_.size() == kMaxFragments) return false;
    if (!is_offset_table) pixels_.push_back(fragment);
  }
}

std::vector<std::span<const char>> DicomFile::pixels() const {
  std::vector<std::span<const char>> pieces;
  for (const Element& element : pixels_) pieces.emplace_back(bytes_.data() + element.begin, element.size);
  return pieces;
}

std::string to_utf8(std::string_view text, std::string_view character_set) {
  const bool is_latin = character_set.find("ISO_IR 100") != std::string_view::npos;
  const bool is_unicode = character_set.empty() || character_set.find("ISO_IR 192") != std::string_view::npos;
  std::string out;
  while (!text.empty()) {
    const auto byte = static_cast<unsigned char>(text.front());
    std::size_t size = 1;
    if (byte < 0x80) {
      out += byte < 0x20 ? ' ' : text.front();
    } else if (is_latin) {
      out += static_cast<char>(0xc0 | byte >> 6);
      out += static_cast<char>(0x80 | (byte & 0x3f));
    } else if (const std::size_t valid = is_unicode ? utf8_size(text) : 0; valid > 0) {
      out += text.substr(0, valid);
      size = valid;
    } else {
      out += '?';
    }
    text.remove_prefix(size);
  }
  return out;
}

}  // namespace trocar::dicom
