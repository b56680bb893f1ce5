#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "dicom/elements/dicom_file.h"
#include "dicom/segmentation/detail/seg_header.h"
#include "dicom/segmentation/segmentation.h"

namespace trocar::dicom::detail {

/// The pixels of a SEG, frame by frame.
class SegPixels {
 public:
  /// Errors (at `where`): fewer pixels than the header says, a compression that `decode` is needed for, or one in which
  /// the frames cannot be told apart. `file` and `decode` must outlive the object.
  static Result<SegPixels> open(const DicomFile& file, const SegHeader& header, const FrameDecoder& decode,
                                const std::string& where);

  /// Numbers of one frame: 0 or 1, the fraction, or the number of the segment. Error: it cannot be unpacked.
  Status read(std::size_t frame, std::vector<std::uint16_t>& pixels) const;

 private:
  SegPixels(const DicomFile& file, const SegHeader& header, const FrameDecoder& decode, std::string where)
      : file_(&file), header_(&header), decode_(&decode), where_(std::move(where)) {}
  static void read_bits(std::span<const char> bytes, std::size_t first_bit, std::vector<std::uint16_t>& pixels);
  void read_numbers(std::span<const char> bytes, bool is_big_endian, std::vector<std::uint16_t>& pixels) const;
  std::size_t pixel_count() const {
    return static_cast<std::size_t>(header_->columns) * static_cast<std::size_t>(header_->rows);
  }

  const DicomFile* file_;
  const SegHeader* header_;
  const FrameDecoder* decode_;
  std::string where_;
  std::vector<std::span<const char>> pieces_;  ///< All pixels, or one piece a frame.
};

}  // namespace trocar::dicom::detail
