#include "io/dicom/detail/dicom_slice.h"

#include <gdcmFragment.h>
#include <gdcmImage.h>
#include <gdcmSequenceOfFragments.h>
#include <gdcmTrace.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <string_view>
#include <vector>

#include "core/decimal_point.h"
#include "core/parse_number.h"
#include "io/dicom/detail/codestream.h"
#include "io/dicom/detail/dicom_header.h"
#include "io/image/detail/quiet.h"

namespace trocar::io::detail {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kRle = "1.2.840.10008.1.2.5";  ///< DICOM PS3.5, annex A.
constexpr std::string_view kDeflated = "1.2.840.10008.1.2.1.99";
constexpr const char* kExportSeriesAgain = "export the series again, uncompressed";

/// Numbers of a decimal string "a\b\c": exactly as many as requested, or empty.
template <std::size_t N>
std::optional<std::array<double, N>> decimals_of(const DicomHeader& header, std::uint32_t tag) {
  const std::string text = header.text(tag);
  std::array<double, N> numbers{};
  std::size_t begin = 0;
  for (double& number : numbers) {
    if (begin > text.size()) return std::nullopt;
    const std::size_t end = std::min(text.find('\\', begin), text.size());
    const std::size_t first = text.find_first_not_of(" +", begin);
    if (first >= end) return std::nullopt;
    const auto found = find_leading_number<double>(std::string_view(text).substr(first, end - first));
    if (!found) return std::nullopt;
    number = found->value;
    begin = end + 1;
  }
  return numbers;
}

DicomSlice slice_of(const DicomHeader& header) {
  DicomSlice slice;
  slice.series_uid = header.text(dicom_tags::kSeriesUid);
  slice.instance_uid = header.text(dicom_tags::kInstanceUid);
  slice.is_localizer = header.text(dicom_tags::kImageType).find("LOCALIZER") != std::string::npos;
  slice.series_description = header.text(dicom_tags::kSeriesDescription);
  slice.modality = header.text(dicom_tags::kModality);
  slice.patient_id = header.text(dicom_tags::kPatientId);
  slice.frame_of_reference = header.text(dicom_tags::kFrameOfReference);
  slice.rows = header.number(dicom_tags::kRows).value_or(0);
  slice.columns = header.number(dicom_tags::kColumns).value_or(0);
  slice.samples_per_pixel = header.number(dicom_tags::kSamplesPerPixel).value_or(1);
  if (const auto frames = decimals_of<1>(header, dicom_tags::kNumberOfFrames))
    slice.frames = static_cast<int>(std::clamp((*frames)[0], 0.0, 1e6));
  if (const auto p = decimals_of<3>(header, dicom_tags::kImagePosition))
    slice.position_P = Vec3((*p)[0], (*p)[1], (*p)[2]);
  if (const auto d = decimals_of<6>(header, dicom_tags::kImageOrientation))
    slice.directions_P = {Vec3((*d)[0], (*d)[1], (*d)[2]), Vec3((*d)[3], (*d)[4], (*d)[5])};
  // DICOM gives the distance between rows first.
  if (const auto s = decimals_of<2>(header, dicom_tags::kPixelSpacing)) slice.spacing_mm = {(*s)[1], (*s)[0]};
  if (const auto slope = decimals_of<1>(header, dicom_tags::kRescaleSlope)) slice.slope = (*slope)[0];
  if (const auto intercept = decimals_of<1>(header, dicom_tags::kRescaleIntercept)) slice.intercept = (*intercept)[0];
  const auto bytes_per_pixel = static_cast<std::size_t>(header.number(dicom_tags::kBitsAllocated).value_or(16) / 8);
  slice.declared_bytes = static_cast<std::size_t>(slice.columns) * static_cast<std::size_t>(slice.rows) *
                         static_cast<std::size_t>(std::max(slice.samples_per_pixel, 1)) * bytes_per_pixel;
  const auto pixels = header.pixels();
  slice.is_cut = !header.is_compressed() && (pixels.empty() || pixels.front().size() < slice.declared_bytes);
  return slice;
}

/// Pixel encoding (PS3.3, C.7.6.3).
struct PixelLayout {
  int bits_allocated = 16;
  int bits_stored = 16;
  int high_bit = 15;
  bool is_signed = false;
  std::size_t count = 0;

  std::size_t bytes() const { return count * static_cast<std::size_t>(bits_allocated / 8); }
  VoxelType type() const {
    if (bits_allocated == 8) return is_signed ? VoxelType::kInt8 : VoxelType::kUInt8;
    return is_signed ? VoxelType::kInt16 : VoxelType::kUInt16;
  }
};

Result<PixelLayout> layout_of(const DicomHeader& header, const DicomSlice& slice) {
  PixelLayout layout;
  layout.bits_allocated = header.number(dicom_tags::kBitsAllocated).value_or(16);
  layout.bits_stored = header.number(dicom_tags::kBitsStored).value_or(layout.bits_allocated);
  layout.high_bit = header.number(dicom_tags::kHighBit).value_or(layout.bits_stored - 1);
  layout.is_signed = header.number(dicom_tags::kPixelRepresentation).value_or(0) != 0;
  layout.count = static_cast<std::size_t>(slice.columns) * static_cast<std::size_t>(slice.rows);
  const bool is_known = (layout.bits_allocated == 8 || layout.bits_allocated == 16) && layout.bits_stored >= 1 &&
                        layout.high_bit < layout.bits_allocated && layout.high_bit + 1 >= layout.bits_stored &&
                        header.text(dicom_tags::kPhotometric) != "PALETTE COLOR";
  if (is_known) return layout;
  return fail("stores its pixels in an unknown way", slice.file.string(), "give a CT series or a mask series");
}

/// Uncompressed pixels: converted to this machine's byte order, with the unused bits (old overlays) cleared.
void unpack_plain(std::span<const char> pixels, bool is_big_endian, const PixelLayout& layout,
                  std::span<std::byte> out) {
  std::memcpy(out.data(), pixels.data(), out.size());
  if (layout.bits_allocated == 8 && layout.bits_stored == 8) return;
  if (layout.bits_allocated == 16 && layout.bits_stored == 16 && !is_big_endian) return;
  const int width = layout.bits_allocated / 8;
  const int down = layout.high_bit + 1 - layout.bits_stored;
  const int up = 32 - layout.bits_stored;
  for (std::size_t at = 0; at + static_cast<std::size_t>(width) <= out.size(); at += static_cast<std::size_t>(width)) {
    std::byte* pixel = out.data() + at;
    if (width == 2 && is_big_endian) std::swap(pixel[0], pixel[1]);
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

/// Compressed pixels of one image, and the image that they should be.
struct CompressedImage {
  std::vector<std::span<const char>> pieces;
  std::string transfer_syntax;
  int columns = 0;
  int rows = 0;
};

/// Run-length coded pixels, the high bytes first. GDCM is not used: a damaged file ends the program there.
bool unpack_rle(const CompressedImage& image, const PixelLayout& layout, std::span<std::byte> out) {
  constexpr std::size_t kRleHeader = 64;
  std::vector<char> bytes;
  for (const std::span<const char> piece : image.pieces) bytes.insert(bytes.end(), piece.begin(), piece.end());
  const auto planes = static_cast<std::size_t>(layout.bits_allocated / 8);
  if (bytes.size() < kRleHeader || little_endian_32(bytes, 0) != planes) return false;
  for (std::size_t plane = 0; plane < planes; ++plane) {
    const std::size_t begin = little_endian_32(bytes, 4 + 4 * plane);
    if (begin < kRleHeader || begin > bytes.size()) return false;
    if (!unpack_rle_plane(std::span(bytes).subspan(begin), out.subspan(planes - 1 - plane), planes)) return false;
  }
  return true;
}

/// Whether the stream holds the image that the header describes; GDCM ends the program where it holds more components.
bool is_as_described(const CompressedImage& image) {
  std::vector<char> start;
  constexpr std::size_t kLongestStart = 1 << 20;  // comments and tables may come before the size
  for (const std::span<const char> piece : image.pieces) {
    if (start.size() >= kLongestStart) break;
    start.insert(start.end(), piece.begin(),
                 piece.begin() + static_cast<std::ptrdiff_t>(std::min(piece.size(), kLongestStart)));
  }
  const auto size = codestream_size(start);
  return size && size->components == 1 && size->columns == image.columns && size->rows == image.rows;
}

/// Unpacks the fragments with GDCM's codecs. May throw exceptions of GDCM.
bool unpack_compressed(const CompressedImage& packed, const PixelLayout& layout, std::span<std::byte> out) {
  if (packed.transfer_syntax == kRle) return unpack_rle(packed, layout, out);
  const auto syntax = gdcm::TransferSyntax::GetTSType(packed.transfer_syntax.c_str());
  if (syntax == gdcm::TransferSyntax::TS_END || !is_as_described(packed)) return false;
  gdcm::SmartPointer<gdcm::SequenceOfFragments> fragments = new gdcm::SequenceOfFragments;
  for (const std::span<const char> piece : packed.pieces) {
    gdcm::Fragment fragment;
    fragment.SetByteValue(piece.data(), gdcm::VL(static_cast<std::uint32_t>(piece.size())));
    fragments->AddFragment(fragment);
  }
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

/// May throw exceptions of GDCM.
Status decode_throwing(const DicomSlice& slice, const std::function<Status(const RawVoxels&)>& use) {
  const std::string where = slice.file.string();
  TROCAR_TRY(const std::optional<DicomHeader> header, DicomHeader::read(slice.file));
  if (!header) return fail("not a DICOM image any more", where, kExportSeriesAgain);
  TROCAR_TRY(const PixelLayout layout, layout_of(*header, slice));
  const std::vector<std::span<const char>> pieces = header->pixels();
  if (pieces.empty()) return fail("has no pixels that could be read", where, kExportSeriesAgain);
  std::vector<std::byte> pixels(layout.bytes());
  if (header->is_compressed()) {
    if (!unpack_compressed({pieces, header->transfer_syntax(), slice.columns, slice.rows}, layout, pixels))
      return fail("the DICOM image cannot be unpacked", where, kExportSeriesAgain);
  } else if (pieces.front().size() < pixels.size()) {
    return fail("the DICOM image ends before its last pixel", where, kExportSeriesAgain);
  } else {
    unpack_plain(pieces.front(), header->is_big_endian(), layout, pixels);
  }
  if (auto status = use({layout.type(), pixels, slice.slope, slice.intercept}); !status)
    return fail(status.error().what, where, status.error().advice);
  return {};
}

/// What is wrong with a file is said once, by our error.
void silence_gdcm() {
  gdcm::Trace::DebugOff();
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
}

}  // namespace

Result<std::optional<DicomSlice>> find_dicom_slice(const fs::path& path) {
  TROCAR_TRY(const std::optional<DicomHeader> header, DicomHeader::read(path));
  if (!header) return std::optional<DicomSlice>();
  // Its elements cannot be read; silently skipping a slice would shift the others.
  if (header->transfer_syntax() == kDeflated)
    return fail("deflated DICOM is not supported", path.string(), kExportSeriesAgain);
  DicomSlice slice = slice_of(*header);
  slice.file = path;
  return slice.rows > 0 && slice.columns > 0 ? std::optional(slice) : std::nullopt;
}

Status decode_slice(const DicomSlice& slice, const std::function<Status(const RawVoxels&)>& use) {
  silence_gdcm();
  try {
    return decode_throwing(slice, use);
  } catch (const std::bad_alloc&) {
    return fail("not enough memory to read the image", slice.file.string(), "close other programs");
  } catch (const std::exception&) {
    return fail("the DICOM image is damaged", slice.file.string(), kExportSeriesAgain);
  }
}

Status decode_frame(const dicom::CompressedFrame& frame, std::span<std::byte> out) {
  silence_gdcm();
  PixelLayout layout;
  layout.bits_allocated = layout.bits_stored = std::max(frame.bits, 8);  // single bits are packed into bytes
  layout.high_bit = layout.bits_stored - 1;
  layout.count = static_cast<std::size_t>(frame.columns) * static_cast<std::size_t>(frame.rows);
  if (frame.bits == 1) layout.count = (layout.count + 7) / 8;
  const char* reason = "cannot be unpacked";
  try {
    if (layout.bytes() == out.size() &&
        unpack_compressed({{frame.bytes}, frame.transfer_syntax, frame.columns, frame.rows}, layout, out))
      return {};
  } catch (const std::exception&) {
    reason = "is damaged";
  }
  return fail(reason, frame.transfer_syntax, kExportSeriesAgain);
}

}  // namespace trocar::io::detail
