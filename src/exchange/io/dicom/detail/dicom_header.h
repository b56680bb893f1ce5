#pragma once

#include <array>
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

/// The elements that are read. A file may have millions of other elements: these are not stored.
namespace dicom_tags {
inline constexpr std::uint32_t kTransferSyntax = dicom_tag(0x0002, 0x0010);
inline constexpr std::uint32_t kModality = dicom_tag(0x0008, 0x0060);
inline constexpr std::uint32_t kSeriesDescription = dicom_tag(0x0008, 0x103e);
inline constexpr std::uint32_t kPatientId = dicom_tag(0x0010, 0x0020);
inline constexpr std::uint32_t kSeriesUid = dicom_tag(0x0020, 0x000e);
inline constexpr std::uint32_t kImagePosition = dicom_tag(0x0020, 0x0032);
inline constexpr std::uint32_t kImageOrientation = dicom_tag(0x0020, 0x0037);
inline constexpr std::uint32_t kFrameOfReference = dicom_tag(0x0020, 0x0052);
inline constexpr std::uint32_t kSamplesPerPixel = dicom_tag(0x0028, 0x0002);
inline constexpr std::uint32_t kPhotometric = dicom_tag(0x0028, 0x0004);
inline constexpr std::uint32_t kNumberOfFrames = dicom_tag(0x0028, 0x0008);
inline constexpr std::uint32_t kRows = dicom_tag(0x0028, 0x0010);
inline constexpr std::uint32_t kColumns = dicom_tag(0x0028, 0x0011);
inline constexpr std::uint32_t kPixelSpacing = dicom_tag(0x0028, 0x0030);
inline constexpr std::uint32_t kBitsAllocated = dicom_tag(0x0028, 0x0100);
inline constexpr std::uint32_t kBitsStored = dicom_tag(0x0028, 0x0101);
inline constexpr std::uint32_t kHighBit = dicom_tag(0x0028, 0x0102);
inline constexpr std::uint32_t kPixelRepresentation = dicom_tag(0x0028, 0x0103);
inline constexpr std::uint32_t kRescaleIntercept = dicom_tag(0x0028, 0x1052);
inline constexpr std::uint32_t kRescaleSlope = dicom_tag(0x0028, 0x1053);
inline constexpr std::array kAll{
    kTransferSyntax,   kModality,         kSeriesDescription, kPatientId,   kSeriesUid,      kImagePosition,
    kImageOrientation, kFrameOfReference, kSamplesPerPixel,   kPhotometric, kNumberOfFrames, kRows,
    kColumns,          kPixelSpacing,     kBitsAllocated,     kBitsStored,  kHighBit,        kPixelRepresentation,
    kRescaleIntercept, kRescaleSlope};
}  // namespace dicom_tags

/// Parsed header of one DICOM file: short elements of the top level and the position of the pixels. Every length is
/// checked against the file size before use: Debian's GDCM aborts the program on truncated or damaged files, so GDCM
/// receives only the compressed pixels. Elements as in DICOM PS3.5, section 7.
class DicomHeader {
 public:
  /// Empty if the file is not DICOM; an error if it is a damaged or truncated DICOM file.
  static Result<std::optional<DicomHeader>> read(const std::filesystem::path& path);

  /// Text of an element without its padding; empty if the element is missing.
  std::string text(std::uint32_t tag) const;
  /// Unsigned short (US).
  std::optional<int> number(std::uint32_t tag) const;
  const std::string& transfer_syntax() const noexcept { return transfer_syntax_; }
  bool is_big_endian() const noexcept { return is_big_endian_; }
  bool is_compressed() const noexcept { return is_compressed_; }
  /// One span if the pixels are not compressed, else the fragments without the offset table. Empty if there are no
  /// pixels.
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
