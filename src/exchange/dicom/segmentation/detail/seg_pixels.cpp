#include "dicom/segmentation/detail/seg_pixels.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>

#include "core/available_memory.h"
#include "core/result.h"

namespace trocar::dicom::detail {
namespace {

constexpr std::string_view kRunLength = "1.2.840.10008.1.2.5";  ///< DICOM PS3.5, annex A.
constexpr const char* kUncompressed = "export the segmentation again, uncompressed (Explicit VR Little Endian)";

}  // namespace

Result<SegPixels> SegPixels::open(const DicomFile& file, const SegHeader& header, const FrameDecoder& decode,
                                  const std::string& where) {
  SegPixels pixels(file, header, decode, where);
  pixels.pieces_ = file.pixels();
  if (file.is_compressed()) {
    if (!decode || (header.bits == 1 && file.transfer_syntax() != kRunLength))
      return fail(fmt::format("the pixels of the DICOM segmentation are compressed (transfer syntax {})",
                              to_utf8(file.transfer_syntax(), "none")),
                  where, kUncompressed);
    if (pixels.pieces_.size() != header.frames.size())
      return fail(fmt::format("the {} frames of the DICOM segmentation are compressed in {} parts",
                              header.frames.size(), pixels.pieces_.size()),
                  where, kUncompressed);
    return pixels;
  }
  // All frames follow each other, bit by bit: at most 2^20 frames of 2^32 pixels of 16 bits.
  const std::uint64_t bits =
      static_cast<std::uint64_t>(header.frames.size()) * pixels.pixel_count() * static_cast<std::uint64_t>(header.bits);
  if (pixels.pieces_.empty() || pixels.pieces_.front().size() < (bits + 7) / 8)
    return fail("the DICOM segmentation ends before its last frame", where, "copy or export it again");
  return pixels;
}

void SegPixels::read_bits(std::span<const char> bytes, std::size_t first_bit, std::vector<std::uint16_t>& pixels) {
  std::size_t bit = first_bit;
  for (std::uint16_t& pixel : pixels) {
    pixel = static_cast<std::uint16_t>(static_cast<unsigned char>(bytes[bit / 8]) >> bit % 8 & 1);
    ++bit;
  }
}

void SegPixels::read_numbers(std::span<const char> bytes, bool is_big_endian,
                             std::vector<std::uint16_t>& pixels) const {
  const auto byte = [&](std::size_t at) { return static_cast<std::uint16_t>(static_cast<unsigned char>(bytes[at])); };
  if (header_->bits == 8) {
    for (std::size_t n = 0; n < pixels.size(); ++n) pixels[n] = byte(n);
    return;
  }
  const std::size_t low = is_big_endian ? 1 : 0;
  for (std::size_t n = 0; n < pixels.size(); ++n)
    pixels[n] = static_cast<std::uint16_t>(byte(2 * n + low) | byte(2 * n + 1 - low) << 8);
}

Status SegPixels::read(std::size_t frame, std::vector<std::uint16_t>& pixels) const {
  pixels.resize(pixel_count());
  const std::size_t frame_bytes = (pixels.size() * static_cast<std::size_t>(header_->bits) + 7) / 8;
  if (!file_->is_compressed()) {
    // One bit a pixel: frames follow each other without a gap, also within a byte.
    if (header_->bits == 1)
      read_bits(pieces_.front(), frame * pixels.size(), pixels);
    else
      read_numbers(pieces_.front().subspan(frame * frame_bytes, frame_bytes), file_->is_big_endian(), pixels);
    return {};
  }
  std::vector<char> bytes(frame_bytes);
  const CompressedFrame compressed{pieces_[frame], file_->transfer_syntax(), header_->columns, header_->rows,
                                   header_->bits};
  if (const Status unpacked = (*decode_)(compressed, std::as_writable_bytes(std::span(bytes))); !unpacked)
    return fail(fmt::format("frame {}: {}", frame + 1, unpacked.error().what), where_, kUncompressed);
  if (header_->bits == 1)
    read_bits(bytes, 0, pixels);
  else
    read_numbers(bytes, false, pixels);
  return {};
}

namespace {

constexpr std::size_t kMostEmptyPlanes = 3;

bool share_a_pixel(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, std::uint8_t value) {
  for (std::size_t n = 0; n < a.size(); ++n)
    if (a[n] == value && b[n] == value) return true;
  return false;
}

}  // namespace

std::vector<PlaneGaps> find_plane_gaps(const LabelLayers::Layer& layer, const SliceStack& stack) {
  std::vector<PlaneGaps> gaps(layer.segments.size());
  std::vector<std::optional<std::size_t>> last(layer.segments.size());
  const auto plane_size = static_cast<std::size_t>(stack.columns * stack.rows);
  const auto pixels_of = [&](std::size_t plane) {
    return std::span(layer.voxels).subspan(plane * plane_size, plane_size);
  };
  for (std::size_t plane = 0; plane < stack.origins_P.size(); ++plane) {
    std::vector<bool> is_here(kMostValues + 1, false);
    for (const std::uint8_t value : pixels_of(plane)) is_here[value] = true;
    for (std::size_t n = 0; n < gaps.size(); ++n) {
      if (!is_here[n + 1]) continue;
      ++gaps[n].drawn;
      if (last[n] && plane - *last[n] > 1 && plane - *last[n] <= kMostEmptyPlanes + 1 &&
          share_a_pixel(pixels_of(*last[n]), pixels_of(plane), static_cast<std::uint8_t>(n + 1))) {
        ++gaps[n].count;
        gaps[n].widest_mm = std::max(gaps[n].widest_mm, stack.along_mm(plane) - stack.along_mm(*last[n]));
      }
      last[n] = plane;
    }
  }
  return gaps;
}

namespace {

bool overlap(std::span<const std::uint8_t> mask, std::span<const std::uint8_t> voxels) {
  for (std::size_t n = 0; n < mask.size(); ++n)
    if (mask[n] != 0 && voxels[n] != 0) return true;
  return false;
}

}  // namespace

Result<LabelLayers::Layer*> LabelLayers::layer_for(std::size_t first, std::span<const std::uint8_t> mask) {
  for (Layer& layer : layers_)
    if (layer.segments.size() < kMostValues && !overlap(mask, std::span(layer.voxels).subspan(first, mask.size())))
      return &layer;
  const auto count = static_cast<std::uint64_t>(size_[0] * size_[1] * size_[2]);
  TROCAR_TRY_STATUS(check_memory_for_image(count, available_memory_bytes(), where_));
  layers_.push_back({std::vector<std::uint8_t>(count, 0), {}});
  return &layers_.back();
}

Status LabelLayers::add(std::size_t segment, std::int64_t first_plane, std::span<const std::uint8_t> mask) {
  if (std::all_of(mask.begin(), mask.end(), [](std::uint8_t value) { return value == 0; })) return {};
  const auto first = static_cast<std::size_t>(first_plane * size_[0] * size_[1]);
  TROCAR_CHECK(first + mask.size() <= static_cast<std::size_t>(size_[0] * size_[1] * size_[2]));
  TROCAR_TRY(Layer* const layer, layer_for(first, mask));
  layer->segments.push_back(segment);
  const auto value = static_cast<std::uint8_t>(layer->segments.size());
  for (std::size_t n = 0; n < mask.size(); ++n)
    if (mask[n] != 0) layer->voxels[first + n] = value;
  return {};
}

}  // namespace trocar::dicom::detail
