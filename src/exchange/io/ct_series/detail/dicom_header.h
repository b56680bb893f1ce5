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
#include "dicom/elements/dicom_file.h"

namespace trocar::io::detail {

/// The elements that are read. A file may have millions of other elements: these are not stored.
namespace dicom_tags {
inline constexpr std::uint32_t kImageType = dicom::tag(0x0008, 0x0008);
inline constexpr std::uint32_t kSopClass = dicom::tag(0x0008, 0x0016);
inline constexpr std::uint32_t kInstanceUid = dicom::tag(0x0008, 0x0018);
inline constexpr std::uint32_t kModality = dicom::tag(0x0008, 0x0060);
inline constexpr std::uint32_t kSeriesDescription = dicom::tag(0x0008, 0x103e);
inline constexpr std::uint32_t kPatientId = dicom::tag(0x0010, 0x0020);
inline constexpr std::uint32_t kSeriesUid = dicom::tag(0x0020, 0x000e);
inline constexpr std::uint32_t kAcquisition = dicom::tag(0x0020, 0x0012);
inline constexpr std::uint32_t kImagePosition = dicom::tag(0x0020, 0x0032);
inline constexpr std::uint32_t kImageOrientation = dicom::tag(0x0020, 0x0037);
inline constexpr std::uint32_t kFrameOfReference = dicom::tag(0x0020, 0x0052);
inline constexpr std::uint32_t kTemporalPosition = dicom::tag(0x0020, 0x0100);
inline constexpr std::uint32_t kSamplesPerPixel = dicom::tag(0x0028, 0x0002);
inline constexpr std::uint32_t kPhotometric = dicom::tag(0x0028, 0x0004);
inline constexpr std::uint32_t kNumberOfFrames = dicom::tag(0x0028, 0x0008);
inline constexpr std::uint32_t kRows = dicom::tag(0x0028, 0x0010);
inline constexpr std::uint32_t kColumns = dicom::tag(0x0028, 0x0011);
inline constexpr std::uint32_t kPixelSpacing = dicom::tag(0x0028, 0x0030);
inline constexpr std::uint32_t kBitsAllocated = dicom::tag(0x0028, 0x0100);
inline constexpr std::uint32_t kBitsStored = dicom::tag(0x0028, 0x0101);
inline constexpr std::uint32_t kHighBit = dicom::tag(0x0028, 0x0102);
inline constexpr std::uint32_t kPixelRepresentation = dicom::tag(0x0028, 0x0103);
inline constexpr std::uint32_t kPadding = dicom::tag(0x0028, 0x0120);
inline constexpr std::uint32_t kPaddingLimit = dicom::tag(0x0028, 0x0121);
inline constexpr std::uint32_t kRescaleIntercept = dicom::tag(0x0028, 0x1052);
inline constexpr std::uint32_t kRescaleSlope = dicom::tag(0x0028, 0x1053);
inline constexpr std::array kAll{kImageType,         kSopClass,
                                 kInstanceUid,       kModality,
                                 kSeriesDescription, kPatientId,
                                 kSeriesUid,         kAcquisition,
                                 kImagePosition,     kImageOrientation,
                                 kFrameOfReference,  kTemporalPosition,
                                 kSamplesPerPixel,   kPhotometric,
                                 kNumberOfFrames,    kRows,
                                 kColumns,           kPixelSpacing,
                                 kBitsAllocated,     kBitsStored,
                                 kHighBit,           kPixelRepresentation,
                                 kPadding,           kPaddingLimit,
                                 kRescaleIntercept,  kRescaleSlope};
}  // namespace dicom_tags

/// Parsed header of one DICOM file: short elements of the top level and the position of the pixels. Every length was
/// checked against the file size (dicom/elements): Debian's GDCM aborts the program on truncated or damaged files, so
/// GDCM receives only the compressed pixels.
class DicomHeader {
 public:
  /// Empty if the file is not DICOM; an error if it is a damaged or truncated DICOM file.
  static Result<std::optional<DicomHeader>> read(const std::filesystem::path& path);

  /// Text of an element without its padding; empty if the element is missing.
  std::string text(std::uint32_t tag) const;
  /// Unsigned short (US).
  std::optional<int> number(std::uint32_t tag) const;
  dicom::DicomItem root() const noexcept { return file_.root(); }
  const std::string& transfer_syntax() const noexcept { return file_.transfer_syntax(); }
  bool is_big_endian() const noexcept { return file_.is_big_endian(); }
  bool is_compressed() const noexcept { return file_.is_compressed(); }
  /// One span if the pixels are not compressed, else the fragments without the offset table. Empty if there are no
  /// pixels.
  std::vector<std::span<const char>> pixels() const { return file_.pixels(); }

 private:
  explicit DicomHeader(dicom::DicomFile file);
  std::string_view bytes_of(std::uint32_t tag) const;

  dicom::DicomFile file_;
  std::map<std::uint32_t, dicom::Element> elements_;
};

}  // namespace trocar::io::detail
