#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"

namespace trocar::io::detail {

/// (group, element), for example dicom_tag(0x0028, 0x0010).
constexpr std::uint32_t dicom_tag(std::uint16_t group, std::uint16_t element) {
  return (static_cast<std::uint32_t>(group) << 16) | element;
}

/// One DICOM file taken apart: short elements of the top level and where the pixels lie. Every length is held against
/// the file before it is used: GDCM as Debian builds it aborts the program on cut or damaged files, so it never sees
/// their structure, only the compressed pixels. Elements as in DICOM PS3.5, section 7.
class DicomHeader {
 public:
  /// Nothing where the file is no DICOM; an error where it is one, but damaged or cut.
  static Result<std::optional<DicomHeader>> read(const std::filesystem::path& path);

  /// Text of an element without its padding; empty where it is missing.
  std::string text(std::uint32_t tag) const;
  /// Unsigned short (US).
  std::optional<int> number(std::uint32_t tag) const;
  const std::string& transfer_syntax() const noexcept { return transfer_syntax_; }
  bool is_big_endian() const noexcept { return is_big_endian_; }
  bool is_compressed() const noexcept { return is_compressed_; }
  /// One piece where the pixels are not compressed, else the fragments without the offset table. Empty: no pixels.
  std::vector<std::span<const char>> pixels() const;

 private:
  struct Range {
    std::size_t begin = 0;
    std::size_t size = 0;
  };
  friend class DicomWalk;

  std::string bytes_;
  std::map<std::uint32_t, Range> elements_;
  std::vector<Range> pixels_;
  std::string transfer_syntax_;
  bool is_big_endian_ = false;
  bool is_compressed_ = false;
};

}  // namespace trocar::io::detail
