#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "dicom/pacs/detail/element_writer.h"

namespace trocar::dicom::detail {

/// Elements of a data set, or of an item, in the order of their tags; explicit VR little endian.
class DataElements {
 public:
  void text(std::uint32_t tag, std::string_view vr, std::string_view value);
  void decimal(std::uint32_t tag, double value);
  void decimals(std::uint32_t tag, const std::vector<double>& values);
  void integer(std::uint32_t tag, long value);
  void number(std::uint32_t tag, int value);
  void tag_pointer(std::uint32_t tag, std::uint32_t target);
  void sequence(std::uint32_t tag, const std::vector<DataElements>& items);
  void write(ElementWriter& writer) const;

 private:
  std::string bytes() const;
  struct Value {
    std::string vr, value;
  };
  std::map<std::uint32_t, Value> elements_;
};

}  // namespace trocar::dicom::detail
