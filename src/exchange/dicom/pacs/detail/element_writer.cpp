#include "dicom/pacs/detail/element_writer.h"

#include <fmt/format.h>

namespace trocar::dicom::detail {
namespace {

constexpr std::size_t kMaxShort = 0xffff;  ///< Largest length of 16 bits.
/// UID of this program as an implementation (PS3.7, D.3.3.2): a UUID below 2.25.
constexpr std::string_view kImplementation = "2.25.177272789833921463255117745380525039137";

std::string number(std::uint32_t value, int bytes, bool is_big_endian) {
  std::string text;
  for (int n = 0; n < bytes; ++n) text += static_cast<char>(value >> 8 * (is_big_endian ? bytes - 1 - n : n) & 0xff);
  return text;
}

std::string tag_bytes(std::uint32_t tag, bool is_big_endian) {
  return number(tag >> 16, 2, is_big_endian) + number(tag & 0xffff, 2, is_big_endian);
}

std::string delimiter(std::uint32_t tag, std::uint32_t length, Encoding encoding) {
  return tag_bytes(tag, encoding.is_big_endian) + number(length, 4, encoding.is_big_endian);
}

/// Tag, value representation and length.
std::string start(std::uint32_t tag, std::string_view vr, std::uint32_t length, Encoding encoding) {
  std::string bytes = tag_bytes(tag, encoding.is_big_endian);
  if (encoding.is_implicit) return bytes + number(length, 4, encoding.is_big_endian);
  bytes += vr;
  if (!has_long_length(vr)) return bytes + number(length, 2, encoding.is_big_endian);
  return bytes + std::string(2, '\0') + number(length, 4, encoding.is_big_endian);
}

std::string_view padding_of(std::string_view vr, std::string_view value) {
  if (value.size() % 2 == 0) return {};
  const bool is_zero = vr == "UI" || vr == "OB" || vr == "UN";
  return is_zero ? std::string_view("\0", 1) : " ";
}

}  // namespace

std::string encoded_element(std::uint32_t tag, std::string_view vr, std::string_view value, Encoding encoding) {
  const std::string_view padding = padding_of(vr, value);
  std::string bytes = start(tag, vr, static_cast<std::uint32_t>(value.size() + padding.size()), encoding);
  return bytes.append(value).append(padding);
}

void ElementWriter::element(std::uint32_t tag, std::string_view vr, std::string_view value, Encoding encoding) {
  const std::string_view padding = padding_of(vr, value);
  const std::size_t size = value.size() + padding.size();
  if (!encoding.is_implicit && !has_long_length(vr) && size > kMaxShort) return;
  out_.write(start(tag, vr, static_cast<std::uint32_t>(size), encoding));
  out_.write(value);
  out_.write(padding);
}

void ElementWriter::begin_sequence(std::uint32_t tag, std::string_view vr, Encoding encoding) {
  out_.write(start(tag, vr, kUndefinedLength, encoding));
}

void ElementWriter::begin_item(Encoding encoding) {
  out_.write(delimiter(kItem, kUndefinedLength, encoding));
}

void ElementWriter::end_item(Encoding encoding) {
  out_.write(delimiter(kItemEnd, 0, encoding));
}

void ElementWriter::end_sequence(Encoding encoding) {
  out_.write(delimiter(kSequenceEnd, 0, encoding));
}

void write_meta(const MetaInformation& meta, OutputFile& out) {
  constexpr Encoding kExplicit;
  std::string group;
  group += encoded_element(tag(0x0002, 0x0001), "OB", std::string_view("\0\1", 2), kExplicit);
  group += encoded_element(tag(0x0002, 0x0002), "UI", meta.sop_class, kExplicit);
  group += encoded_element(tag(0x0002, 0x0003), "UI", meta.sop_instance, kExplicit);
  group += encoded_element(tag(0x0002, 0x0010), "UI", meta.transfer_syntax, kExplicit);
  group += encoded_element(tag(0x0002, 0x0012), "UI", kImplementation, kExplicit);
  group += encoded_element(tag(0x0002, 0x0013), "SH", "TROCAR", kExplicit);
  const std::string length = number(static_cast<std::uint32_t>(group.size()), 4, false);
  out.write(std::string(128, '\0'));
  out.write("DICM");
  out.write(encoded_element(tag(0x0002, 0x0000), "UL", length, kExplicit));
  out.write(group);
}

namespace {

std::string little_endian_4(std::uint32_t value) {
  std::string bytes;
  for (const int shift : {0, 8, 16, 24}) bytes += static_cast<char>(value >> shift & 0xff);
  return bytes;
}

/// At most 16 characters, as DICOM allows for a decimal string (PS3.5, 6.2).
std::string decimal_text(double value) {
  return fmt::format("{:.9g}", value);
}

}  // namespace

void DataElements::text(std::uint32_t tag, std::string_view vr, std::string_view value) {
  elements_[tag] = {std::string(vr), std::string(value)};
}

void DataElements::decimal(std::uint32_t tag, double value) {
  text(tag, "DS", decimal_text(value));
}

void DataElements::decimals(std::uint32_t tag, const std::vector<double>& values) {
  std::string all;
  for (const double value : values) {
    if (!all.empty()) all += '\\';
    all += decimal_text(value);
  }
  text(tag, "DS", all);
}

void DataElements::integer(std::uint32_t tag, long value) {
  text(tag, "IS", std::to_string(value));
}

void DataElements::number(std::uint32_t tag, int value) {
  const auto n = static_cast<std::uint16_t>(value);
  text(tag, "US", std::string{static_cast<char>(n & 0xff), static_cast<char>(n >> 8)});
}

void DataElements::tag_pointer(std::uint32_t tag, std::uint32_t target) {
  std::string bytes;
  for (const int shift : {16, 24, 0, 8}) bytes += static_cast<char>(target >> shift & 0xff);
  text(tag, "AT", bytes);
}

void DataElements::sequence(std::uint32_t tag, const std::vector<DataElements>& items) {
  std::string value;
  for (const DataElements& item : items) {
    const std::string inside = item.bytes();
    // Item (FFFE,E000) with its length.
    value += std::string("\xfe\xff\x00\xe0", 4) + little_endian_4(static_cast<std::uint32_t>(inside.size())) + inside;
  }
  text(tag, "SQ", value);
}

std::string DataElements::bytes() const {
  std::string all;
  for (const auto& [tag, element] : elements_) all += encoded_element(tag, element.vr, element.value, Encoding{});
  return all;
}

void DataElements::write(ElementWriter& writer) const {
  for (const auto& [tag, element] : elements_) writer.element(tag, element.vr, element.value, Encoding{});
}

}  // namespace trocar::dicom::detail
