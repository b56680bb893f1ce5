#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "dicom/segmentation/segmentation.h"
#include "geometry/vec.h"
#include "io/ct_series/detail/dicom_header.h"
#include "io/image/detail/raw_volume.h"

namespace trocar::io::detail {

/// Header data of one DICOM image. Frame P is DICOM's patient frame: LPS, mm.
struct DicomSlice {
  std::filesystem::path file;
  std::string series_uid;
  std::string instance_uid;  ///< Of this image; a copy of the file has the same.
  std::string series_description;
  std::string modality;            ///< "CT", "MR" …; empty if the file has none.
  std::string patient_id;          ///< Compared among slices, never displayed.
  std::string frame_of_reference;  ///< UID; positions in another frame are not comparable.
  std::string acquisition;         ///< Numbers of the acquisition and of the time point, for comparison.
  int columns = 0;
  int rows = 0;
  int frames = 1;          ///< In its file.
  int frame = 0;           ///< Its own, from 0.
  bool is_placed = false;  ///< A frame of an enhanced file, which states the place of each.
  int samples_per_pixel = 1;
  std::optional<Vec3> position_P;                   ///< Centre of the first pixel.
  std::optional<std::array<Vec3, 2>> directions_P;  ///< Along a row (growing column), along a column.
  std::optional<std::array<double, 2>> spacing_mm;  ///< Between columns, between rows.
  std::size_t declared_bytes = 0;                   ///< Size of the unpacked pixels.
  bool is_localizer = false;                        ///< An overview image (scout, topogram), no slice.
  bool is_capture = false;                          ///< A Secondary Capture: a picture of a screen or a report.
  bool is_cut = false;                              ///< The pixels are uncompressed and fewer than declared.
  std::optional<double> slope;                      ///< Empty if the file does not state it, as the next one.
  std::optional<double> intercept;
  std::optional<std::array<int, 2>> padding;  ///< Stored numbers of padding: lowest, highest.
  /// The first element with a text that is not the numbers it should be: "PixelSpacing is "4,8\4,8"". Empty if there is
  /// none. Such an element counts as missing.
  std::string unreadable;
};

/// Takes the numbers of DICOM elements for a slice.
class NumberReader {
 public:
  explicit NumberReader(DicomSlice& slice) noexcept : slice_(slice) {}
  /// The numbers of a decimal string; empty if there are not `count` of them. Then any text but an empty one makes the
  /// slice unreadable.
  std::vector<double> decimals(std::string_view text, std::size_t count, const char* name);
  std::optional<double> decimal(std::string_view text, const char* name);

 private:
  DicomSlice& slice_;
};

/// Uses the numbers of one slice.
using PixelUse = std::function<Status(const RawVoxels&)>;

/// The images of a DICOM file with or without the "DICM" mark: one, or the frames of an enhanced multi-frame file, each
/// with its own place and scaling. None if the file is not DICOM or has no image. An error if it is a damaged or
/// truncated DICOM file.
Result<std::vector<DicomSlice>> find_dicom_slices(const std::filesystem::path& path);

/// An open file, for those that hold many frames.
class DicomPixels {
 public:
  /// Errors: those of find_dicom_slices().
  static Result<DicomPixels> open(const std::filesystem::path& path);
  /// Unpacks the pixels of one of its slices (uncompressed, JPEG, JPEG-LS, JPEG 2000, RLE) and passes them to `use`.
  /// Thread-safe.
  Status decode(const DicomSlice& slice, const PixelUse& use) const;

 private:
  explicit DicomPixels(DicomHeader header) : header_(std::move(header)) {}
  DicomHeader header_;
};

/// Opens the file of one slice and unpacks it.
Status decode_slice(const DicomSlice& slice, const PixelUse& use);

/// Unpacks one frame of a DICOM SEG by the same codecs. Error (without a file): it cannot be unpacked.
Status decode_frame(const dicom::CompressedFrame& frame, std::span<std::byte> out);

}  // namespace trocar::io::detail
