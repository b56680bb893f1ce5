#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "dicom/elements/dicom_file.h"
#include "dicom/segmentation/detail/seg_header.h"
#include "dicom/segmentation/segmentation.h"
#include "dicom/stack/slice_stack.h"
#include "volume/grid.h"

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

inline constexpr std::size_t kMostValues = 255;  ///< Of a label volume, besides 0.

/// Collects masks of one size in as few label volumes as possible: each volume takes the masks that do not overlap.
class LabelLayers {
 public:
  struct Layer {
    std::vector<std::uint8_t> voxels;
    std::vector<std::size_t> segments;  ///< Of the values 1, 2 …
  };

  /// `where` is the file, for messages.
  LabelLayers(std::array<std::int64_t, 3> size, std::string where) : size_(size), where_(std::move(where)) {}

  /// Adds a structure. `mask` (0 or not 0) has the planes from `first_plane` on; an empty structure is left out. Error:
  /// not enough memory for a further volume.
  Status add(std::size_t segment, std::int64_t first_plane, std::span<const std::uint8_t> mask);
  std::vector<Layer> take() { return std::move(layers_); }

 private:
  Result<Layer*> layer_for(std::size_t first, std::span<const std::uint8_t> mask);
  std::array<std::int64_t, 3> size_;
  std::string where_;
  std::vector<Layer> layers_;
};

/// Empty planes within a structure of a SEG.
struct PlaneGaps {
  std::size_t drawn = 0;   ///< Planes with at least one pixel.
  std::size_t count = 0;   ///< Gaps of one to three planes between two planes that share a pixel.
  double widest_mm = 0.0;  ///< From the plane below to the plane above.
};

/// The gaps of each structure of a layer, in their order: planes that nobody drew, or that lie between those of a
/// thicker scan. Wider gaps, and those between planes without a common pixel, are between separate parts.
std::vector<PlaneGaps> find_plane_gaps(const LabelLayers::Layer& layer, const SliceStack& stack);

}  // namespace trocar::dicom::detail
