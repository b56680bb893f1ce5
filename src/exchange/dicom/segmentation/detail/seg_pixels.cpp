#include "dicom/segmentation/detail/seg_pixels.h"

#include <fmt/format.h>

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

}  // namespace trocar::dicom::detail
