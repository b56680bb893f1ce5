#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "dicom/elements/element_walk.h"
#include "dicom/pacs/detail/object_files.h"

namespace trocar::dicom::detail {

/// Writes elements of a data set in the encoding that each call names. Sequences and items have undefined lengths, so
/// that they can be written before their size is known.
class ElementWriter {
 public:
  explicit ElementWriter(OutputFile& out) noexcept : out_(out) {}

  /// A value of odd length is padded: UIDs and bytes with zero, texts with a space. A value that is too long for its
  /// representation is left out.
  void element(std::uint32_t tag, std::string_view vr, std::string_view value, Encoding encoding);
  void begin_sequence(std::uint32_t tag, std::string_view vr, Encoding encoding);
  void begin_item(Encoding encoding);
  void end_item(Encoding encoding);
  void end_sequence(Encoding encoding);
  void bytes(std::string_view bytes) { out_.write(bytes); }

 private:
  OutputFile& out_;
};

/// One short element as bytes, padded by the same rule.
std::string encoded_element(std::uint32_t tag, std::string_view vr, std::string_view value, Encoding encoding);

struct MetaInformation {
  std::string sop_class;
  std::string sop_instance;
  std::string transfer_syntax;
};

/// Preamble and group 2 of a DICOM file (PS3.10, 7.1).
void write_meta(const MetaInformation& meta, OutputFile& out);

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
