#pragma once

#include <cstdint>
#include <string>
#include <string_view>

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

}  // namespace trocar::dicom::detail
