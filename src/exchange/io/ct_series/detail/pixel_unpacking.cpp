#include "io/ct_series/detail/pixel_unpacking.h"

#include <gdcmFragment.h>
#include <gdcmImage.h>
#include <gdcmSequenceOfFragments.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <string_view>

#include "core/text.h"
#include "io/ct_series/detail/jpeg_segments.h"
#include "io/ct_series/detail/lossless_jpeg.h"
#include "io/image/detail/itk_image.h"

namespace trocar::io::detail {
namespace {

constexpr std::string_view kRle = "1.2.840.10008.1.2.5";  ///< DICOM PS3.5, annex A.
constexpr const char* kExportUncompressed = "export the series again, uncompressed";

void swap_pairs(std::span<std::byte> bytes) {
  for (std::size_t at = 0; at + 2 <= bytes.size(); at += 2) std::swap(bytes[at], bytes[at + 1]);
}

/// Keeps the stored bits of each number, moved down by `down`, with their sign.
void keep_stored_bits(const PixelLayout& layout, int down, std::span<std::byte> out) {
  if (layout.bits_allocated == layout.bits_stored) return;
  const auto width = static_cast<std::size_t>(layout.bits_allocated / 8);
  const int up = 32 - layout.bits_stored;
  for (std::size_t at = 0; at + width <= out.size(); at += width) {
    std::byte* pixel = out.data() + at;
    std::uint32_t stored = std::to_integer<std::uint32_t>(pixel[0]);
    if (width == 2) stored |= std::to_integer<std::uint32_t>(pixel[1]) << 8;
    const std::uint32_t raised = (stored >> down) << up;
    const std::uint32_t value =
        layout.is_signed ? static_cast<std::uint32_t>(static_cast<std::int32_t>(raised) >> up) : raised >> up;
    pixel[0] = static_cast<std::byte>(value & 0xff);
    if (width == 2) pixel[1] = static_cast<std::byte>(value >> 8 & 0xff);
  }
}

std::uint32_t little_endian_32(std::span<const char> bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t n = 0; n < 4; ++n)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + n])) << 8 * n;
  return value;
}

std::vector<char> joined(const std::vector<std::span<const char>>& pieces) {
  std::vector<char> bytes;
  for (const std::span<const char> piece : pieces) bytes.insert(bytes.end(), piece.begin(), piece.end());
  return bytes;
}

/// Unpacks one run-length coded plane of bytes (PS3.5, annex G) into every `stride`-th byte of `out`.
bool unpack_rle_plane(std::span<const char> in, std::span<std::byte> out, std::size_t stride) {
  std::size_t at = 0;
  for (std::size_t to = 0; to < out.size();) {
    if (at >= in.size()) return false;
    const int control = static_cast<signed char>(in[at++]);
    if (control == -128) continue;
    const auto count = static_cast<std::size_t>(control >= 0 ? control + 1 : 1 - control);
    const std::size_t needed = control >= 0 ? count : 1;
    if (needed > in.size() - at) return false;
    for (std::size_t n = 0; n < count && to < out.size(); ++n, to += stride)
      out[to] = static_cast<std::byte>(in[at + (control >= 0 ? n : 0)]);
    at += needed;
  }
  return true;
}

/// Run-length coded pixels, the high bytes first. GDCM is not used: a damaged file ends the program there.
bool unpack_rle(const CompressedImage& image, const PixelLayout& layout, std::span<std::byte> out) {
  constexpr std::size_t kRleHeader = 64;
  const std::vector<char> bytes = joined(image.pieces);
  const auto planes = static_cast<std::size_t>(layout.bits_allocated / 8);
  if (bytes.size() < kRleHeader || little_endian_32(bytes, 0) != planes) return false;
  for (std::size_t plane = 0; plane < planes; ++plane) {
    const std::size_t begin = little_endian_32(bytes, 4 + 4 * plane);
    if (begin < kRleHeader || begin > bytes.size()) return false;
    if (!unpack_rle_plane(std::span(bytes).subspan(begin), out.subspan(planes - 1 - plane), planes)) return false;
  }
  return true;
}

/// JPEG with a frame header of ISO 10918-1, not JPEG-LS or JPEG 2000.
bool is_jpeg(std::string_view transfer_syntax) {
  constexpr std::string_view kJpeg = "1.2.840.10008.1.2.4.";
  if (!transfer_syntax.starts_with(kJpeg)) return false;
  const std::string_view number = transfer_syntax.substr(kJpeg.size());
  return number >= "50" && number <= "70";
}
bool is_lossless(std::string_view transfer_syntax) {
  return transfer_syntax == "1.2.840.10008.1.2.4.57" || transfer_syntax == "1.2.840.10008.1.2.4.70";
}

/// GDCM ends the program where a stream holds more components than its header says, or numbers of more than 16 bits.
bool is_as_described(const CodestreamSize& stream, const CompressedImage& image, const PixelLayout& layout) {
  return stream.components == 1 && stream.columns == image.columns && stream.rows == image.rows && stream.bits >= 1 &&
         stream.bits <= layout.bits_allocated;
}

/// Unpacks a stream with GDCM's codecs. May throw exceptions of GDCM.
bool unpack_with_gdcm(std::span<const char> stream, const CompressedImage& packed, const PixelLayout& layout,
                      std::span<std::byte> out) {
  const auto syntax = gdcm::TransferSyntax::GetTSType(packed.transfer_syntax.c_str());
  if (syntax == gdcm::TransferSyntax::TS_END) return false;
  gdcm::SmartPointer<gdcm::SequenceOfFragments> fragments = new gdcm::SequenceOfFragments;
  gdcm::Fragment fragment;
  fragment.SetByteValue(stream.data(), gdcm::VL(static_cast<std::uint32_t>(stream.size())));
  fragments->AddFragment(fragment);
  gdcm::DataElement pixel_data(gdcm::Tag(0x7fe0, 0x0010));
  pixel_data.SetVR(gdcm::VR::OB);
  pixel_data.SetValue(*fragments);

  gdcm::Image image;
  image.SetNumberOfDimensions(2);
  image.SetDimension(0, static_cast<unsigned>(packed.columns));
  image.SetDimension(1, static_cast<unsigned>(packed.rows));
  image.SetPixelFormat(gdcm::PixelFormat(1, static_cast<unsigned short>(layout.bits_allocated),
                                         static_cast<unsigned short>(layout.bits_stored),
                                         static_cast<unsigned short>(layout.high_bit), layout.is_signed ? 1 : 0));
  image.SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
  image.SetTransferSyntax(syntax);
  image.SetDataElement(pixel_data);
  const MutedStandardError muted;
  const DecimalPoint decimal_point;
  return image.GetBufferLength() == out.size() && image.GetBuffer(reinterpret_cast<char*>(out.data()));
}

/// Unpacks all but run lengths. May throw exceptions of GDCM.
bool unpack_stream(std::vector<char> stream, const CompressedImage& packed, const PixelLayout& layout,
                   std::span<std::byte> out) {
  if (is_jpeg(packed.transfer_syntax)) {
    const bool is_coded_losslessly =
        unpack_lossless_jpeg(stream, packed.columns, packed.rows, layout.bits_allocated / 8, out);
    if (is_coded_losslessly || is_lossless(packed.transfer_syntax)) return is_coded_losslessly;
    auto plain = plain_jpeg(stream);
    if (!plain) return false;
    stream = *std::move(plain);
  }
  return unpack_with_gdcm(stream, packed, layout, out);
}

}  // namespace

void unpack_plain(std::span<const char> pixels, bool is_big_endian, const PixelLayout& layout,
                  std::span<std::byte> out) {
  std::memcpy(out.data(), pixels.data(), out.size());
  if (is_big_endian && layout.bits_allocated == 16) swap_pairs(out);
  keep_stored_bits(layout, layout.high_bit + 1 - layout.bits_stored, out);
}

Status unpack_compressed(const CompressedImage& packed, const PixelLayout& layout, std::span<std::byte> out) {
  const auto damaged = fail("the DICOM image cannot be unpacked", {}, kExportUncompressed);
  if (packed.transfer_syntax == kRle) {
    if (!unpack_rle(packed, layout, out)) return damaged;
    keep_stored_bits(layout, layout.high_bit + 1 - layout.bits_stored, out);
    return {};
  }
  std::vector<char> bytes = joined(packed.pieces);
  const auto stream = codestream_size(bytes);
  if (!stream || !is_as_described(*stream, packed, layout)) return damaged;
  // Only JPEG 2000 states a sign. Unsigned numbers of a signed image are the two's complement of the stored bits.
  if (stream->is_signed && !layout.is_signed)
    return fail("the JPEG 2000 stream has signed numbers, but the header says unsigned ones (PixelRepresentation 0)",
                {}, kExportUncompressed);
  if (stream->bits < layout.bits_stored && layout.is_signed && !stream->is_signed)
    return fail("the sign of the compressed pixels is not known: the stream has fewer bits than the header", {},
                kExportUncompressed);
  if (!unpack_stream(std::move(bytes), packed, layout, out)) return damaged;
  keep_stored_bits(layout, 0, out);  // the lowest bits of a stream's numbers, wherever they were stored before
  return {};
}

}  // namespace trocar::io::detail
