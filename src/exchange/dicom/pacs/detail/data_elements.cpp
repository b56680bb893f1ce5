#include "dicom/pacs/detail/data_elements.h"

#include <fmt/format.h>

namespace trocar::dicom::detail {
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
