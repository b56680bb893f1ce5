#include "io/ct_series/detail/dicom_slice.h"

#include <fmt/format.h>
#include <gdcmTrace.h>

#include <algorithm>
#include <array>
#include <new>
#include <optional>
#include <string_view>
#include <vector>

#include "io/ct_series/detail/pixel_unpacking.h"

namespace trocar::io::detail {

/// The frames of an enhanced file (PS3.3, C.7.6.16): places, directions, spacings and scaling from the functional
/// groups of each frame, or those that all share. A file without such groups gives `whole` itself. Errors: groups that
/// do not fit the number of frames, or are damaged.
Result<std::vector<DicomSlice>> frames_of(const DicomHeader& header, DicomSlice whole);

namespace fs = std::filesystem;
namespace {

constexpr std::string_view kDeflated = "1.2.840.10008.1.2.1.99";
constexpr const char* kExportSeriesAgain = "export the series again, uncompressed";

/// A number as the pixels have it: of the stored bits, with their sign.
int stored_number(int word, int bits_stored, bool is_signed) {
  const int bits = std::clamp(bits_stored, 1, 16);
  const int low = word & ((1 << bits) - 1);
  return is_signed && low >> (bits - 1) != 0 ? low - (1 << bits) : low;
}

std::optional<std::array<int, 2>> padding_of(const DicomHeader& header) {
  const auto value = header.number(dicom_tags::kPadding);
  if (!value) return std::nullopt;
  const int limit = header.number(dicom_tags::kPaddingLimit).value_or(*value);
  const int bits =
      header.number(dicom_tags::kBitsStored).value_or(header.number(dicom_tags::kBitsAllocated).value_or(16));
  const bool is_signed = header.number(dicom_tags::kPixelRepresentation).value_or(0) != 0;
  const int a = stored_number(*value, bits, is_signed), b = stored_number(limit, bits, is_signed);
  return std::array{std::min(a, b), std::max(a, b)};
}

DicomSlice slice_of(const DicomHeader& header) {
  DicomSlice slice;
  slice.series_uid = header.text(dicom_tags::kSeriesUid);
  slice.instance_uid = header.text(dicom_tags::kInstanceUid);
  slice.is_localizer = header.text(dicom_tags::kImageType).find("LOCALIZER") != std::string::npos;
  slice.is_capture = header.text(dicom_tags::kSopClass).starts_with("1.2.840.10008.5.1.4.1.1.7");
  slice.series_description = header.text(dicom_tags::kSeriesDescription);
  slice.modality = header.text(dicom_tags::kModality);
  slice.patient_id = header.text(dicom_tags::kPatientId);
  slice.frame_of_reference = header.text(dicom_tags::kFrameOfReference);
  slice.acquisition = header.text(dicom_tags::kAcquisition) + "/" + header.text(dicom_tags::kTemporalPosition);
  slice.padding = padding_of(header);
  slice.rows = header.number(dicom_tags::kRows).value_or(0);
  slice.columns = header.number(dicom_tags::kColumns).value_or(0);
  slice.samples_per_pixel = header.number(dicom_tags::kSamplesPerPixel).value_or(1);
  NumberReader reader(slice);
  if (const auto frames = reader.decimal(header.text(dicom_tags::kNumberOfFrames), "NumberOfFrames"))
    slice.frames = static_cast<int>(std::clamp(*frames, 0.0, 1e6));
  if (const auto p = reader.decimals(header.text(dicom_tags::kImagePosition), 3, "ImagePositionPatient"); !p.empty())
    slice.position_P = Vec3(p[0], p[1], p[2]);
  if (const auto d = reader.decimals(header.text(dicom_tags::kImageOrientation), 6, "ImageOrientationPatient");
      !d.empty())
    slice.directions_P = {Vec3(d[0], d[1], d[2]), Vec3(d[3], d[4], d[5])};
  // DICOM gives the distance between rows first.
  if (const auto s = reader.decimals(header.text(dicom_tags::kPixelSpacing), 2, "PixelSpacing"); !s.empty())
    slice.spacing_mm = {s[1], s[0]};
  slice.slope = reader.decimal(header.text(dicom_tags::kRescaleSlope), "RescaleSlope");
  slice.intercept = reader.decimal(header.text(dicom_tags::kRescaleIntercept), "RescaleIntercept");
  const auto bytes_per_pixel = static_cast<std::size_t>(header.number(dicom_tags::kBitsAllocated).value_or(16) / 8);
  slice.declared_bytes = static_cast<std::size_t>(slice.columns) * static_cast<std::size_t>(slice.rows) *
                         static_cast<std::size_t>(std::max(slice.samples_per_pixel, 1)) * bytes_per_pixel;
  const auto pixels = header.pixels();
  slice.is_cut = !header.is_compressed() && (pixels.empty() || pixels.front().size() < slice.declared_bytes);
  return slice;
}

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

/// The pixels of one frame.
Status decode_throwing(const DicomHeader& header, const DicomSlice& slice, const PixelUse& use) {
  const std::string where = slice.file.string();
  TROCAR_TRY(const PixelLayout layout, layout_of(header, slice));
  const std::vector<std::span<const char>> pieces = header.pixels();
  if (pieces.empty()) return fail("has no pixels that could be read", where, kExportSeriesAgain);
  const auto frame = static_cast<std::size_t>(slice.frame);
  std::vector<std::byte> pixels(layout.bytes());
  if (header.is_compressed()) {
    const bool is_one_of_many = slice.frames > 1;
    if (is_one_of_many && pieces.size() != static_cast<std::size_t>(slice.frames))
      return fail(fmt::format("its {} frames are compressed in {} parts", slice.frames, pieces.size()), where,
                  kExportSeriesAgain);
    const auto own = is_one_of_many ? std::vector{pieces[frame]} : pieces;
    const Status unpacked =
        unpack_compressed({own, header.transfer_syntax(), slice.columns, slice.rows}, layout, pixels);
    if (!unpacked) return fail(unpacked.error().what, where, unpacked.error().advice);
  } else if (pieces.front().size() / pixels.size() <= frame) {
    return fail("the DICOM image ends before its last pixel", where, kExportSeriesAgain);
  } else {
    unpack_plain(pieces.front().subspan(frame * pixels.size()), header.is_big_endian(), layout, pixels);
  }
  if (auto status = use({layout.type(), pixels, slice.slope.value_or(1.0), slice.intercept.value_or(0.0)}); !status)
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

std::vector<double> NumberReader::decimals(std::string_view text, std::size_t count, const char* name) {
  if (text.find_first_not_of(' ') == std::string_view::npos) return {};
  std::vector<double> numbers = dicom::decimals_in(text);
  if (numbers.size() == count) return numbers;
  constexpr std::size_t kMostShown = 60;
  if (slice_.unreadable.empty())
    slice_.unreadable = fmt::format("{} is \"{}\"", name, dicom::to_utf8(text.substr(0, kMostShown), {}));
  return {};
}

std::optional<double> NumberReader::decimal(std::string_view text, const char* name) {
  const std::vector<double> numbers = decimals(text, 1, name);
  return numbers.empty() ? std::nullopt : std::optional(numbers.front());
}

Result<std::vector<DicomSlice>> find_dicom_slices(const fs::path& path) {
  TROCAR_TRY(const std::optional<DicomHeader> header, DicomHeader::read(path));
  if (!header) return std::vector<DicomSlice>();
  // Its elements cannot be read; silently skipping a slice would shift the others.
  if (header->transfer_syntax() == kDeflated)
    return fail("deflated DICOM is not supported", path.string(), kExportSeriesAgain);
  DicomSlice slice = slice_of(*header);
  slice.file = path;
  if (slice.rows <= 0 || slice.columns <= 0) return std::vector<DicomSlice>();
  return frames_of(*header, std::move(slice));
}

Result<DicomPixels> DicomPixels::open(const fs::path& path) {
  TROCAR_TRY(std::optional<DicomHeader> header, DicomHeader::read(path));
  if (!header) return fail("not a DICOM image any more", path.string(), kExportSeriesAgain);
  return DicomPixels(*std::move(header));
}

Status DicomPixels::decode(const DicomSlice& slice, const PixelUse& use) const {
  silence_gdcm();
  try {
    return decode_throwing(header_, slice, use);
  } catch (const std::bad_alloc&) {
    return fail("not enough memory to read the image", slice.file.string(), "close other programs");
  } catch (const std::exception&) {
    return fail("the DICOM image is damaged", slice.file.string(), kExportSeriesAgain);
  }
}

Status decode_slice(const DicomSlice& slice, const PixelUse& use) {
  TROCAR_TRY(const DicomPixels pixels, DicomPixels::open(slice.file));
  return pixels.decode(slice, use);
}

Status decode_frame(const dicom::CompressedFrame& frame, std::span<std::byte> out) {
  silence_gdcm();
  PixelLayout layout;
  layout.bits_allocated = layout.bits_stored = std::max(frame.bits, 8);  // single bits are packed into bytes
  layout.high_bit = layout.bits_stored - 1;
  layout.count = static_cast<std::size_t>(frame.columns) * static_cast<std::size_t>(frame.rows);
  if (frame.bits == 1) layout.count = (layout.count + 7) / 8;
  try {
    if (layout.bytes() != out.size()) return fail("cannot be unpacked", frame.transfer_syntax, kExportSeriesAgain);
    return unpack_compressed({{frame.bytes}, frame.transfer_syntax, frame.columns, frame.rows}, layout, out);
  } catch (const std::exception&) {
    return fail("is damaged", frame.transfer_syntax, kExportSeriesAgain);
  }
}

namespace {

using dicom::DicomItem;
using dicom::tag;

constexpr std::uint32_t kShared = tag(0x5200, 0x9229), kPerFrame = tag(0x5200, 0x9230);
constexpr std::uint32_t kPlanePosition = tag(0x0020, 0x9113), kPlaneOrientation = tag(0x0020, 0x9116);
constexpr std::uint32_t kPixelMeasures = tag(0x0028, 0x9110), kPixelValues = tag(0x0028, 0x9145);
constexpr std::uint32_t kCtFrameType = tag(0x0018, 0x9329), kFrameType = tag(0x0008, 0x9007);
constexpr std::uint32_t kFrameContent = tag(0x0020, 0x9111), kFrameAcquisition = tag(0x0020, 0x9156);
constexpr std::uint32_t kTemporalPositionIndex = tag(0x0020, 0x9128);  ///< Its low half: there are fewer than 65,536.
constexpr const char* kExportFramesAgain = "export the series again, as one image a file if possible";

/// The functional groups of one frame, and those that all frames share.
struct Groups {
  DicomItem own;
  std::optional<DicomItem> shared;

  /// The text of an element in a macro; empty if there is none.
  std::string_view text(std::uint32_t macro, std::uint32_t element) const {
    const auto item = find(macro);
    return item ? item->text(element) : std::string_view();
  }
  std::optional<DicomItem> find(std::uint32_t macro) const {
    if (auto item = own.first_item(macro)) return item;
    return shared ? shared->first_item(macro) : std::nullopt;
  }
};

void take_groups(const Groups& groups, DicomSlice& slice) {
  // Places of the top level are not those of a frame.
  slice.position_P.reset();
  slice.directions_P.reset();
  slice.spacing_mm.reset();
  NumberReader reader(slice);
  if (const auto p =
          reader.decimals(groups.text(kPlanePosition, dicom_tags::kImagePosition), 3, "ImagePositionPatient");
      !p.empty())
    slice.position_P = Vec3(p[0], p[1], p[2]);
  if (const auto d =
          reader.decimals(groups.text(kPlaneOrientation, dicom_tags::kImageOrientation), 6, "ImageOrientationPatient");
      !d.empty())
    slice.directions_P = {Vec3(d[0], d[1], d[2]), Vec3(d[3], d[4], d[5])};
  if (const auto s = reader.decimals(groups.text(kPixelMeasures, dicom_tags::kPixelSpacing), 2, "PixelSpacing");
      !s.empty())
    slice.spacing_mm = {s[1], s[0]};
  if (const auto slope = reader.decimal(groups.text(kPixelValues, dicom_tags::kRescaleSlope), "RescaleSlope"))
    slice.slope = slope;
  if (const auto intercept =
          reader.decimal(groups.text(kPixelValues, dicom_tags::kRescaleIntercept), "RescaleIntercept"))
    slice.intercept = intercept;
  if (const auto content = groups.own.first_item(kFrameContent))
    slice.acquisition += fmt::format("/{}/{}", content->number(kFrameAcquisition).value_or(0),
                                     content->number(kTemporalPositionIndex).value_or(0));
  if (const auto type = groups.find(kCtFrameType))
    slice.is_localizer = type->text(kFrameType).find("LOCALIZER") != std::string_view::npos;
}

}  // namespace

Result<std::vector<DicomSlice>> frames_of(const DicomHeader& header, DicomSlice whole) {
  const DicomItem root = header.root();
  // Segmentations have such groups, too, but their frames are no slices of a volume.
  const auto groups =
      whole.modality == "SEG" ? Result<std::vector<DicomItem>>(std::vector<DicomItem>()) : root.items(kPerFrame);
  if (!groups) return fail(groups.error().what, whole.file.string(), groups.error().advice);
  if (groups->empty()) return std::vector{std::move(whole)};
  if (groups->size() != static_cast<std::size_t>(whole.frames))
    return fail(fmt::format("has {} frames, but places for {}", whole.frames, groups->size()), whole.file.string(),
                kExportFramesAgain);
  const auto pixels = header.pixels();
  whole.is_cut =
      !header.is_compressed() && (pixels.empty() || pixels.front().size() < whole.declared_bytes * groups->size());
  const std::optional<DicomItem> shared = root.first_item(kShared);
  std::vector<DicomSlice> slices(groups->size(), whole);
  for (std::size_t n = 0; n < slices.size(); ++n) {
    slices[n].frame = static_cast<int>(n);
    slices[n].is_placed = true;
    slices[n].instance_uid += fmt::format(" frame {}", n + 1);
    take_groups({(*groups)[n], shared}, slices[n]);
  }
  return slices;
}

}  // namespace trocar::io::detail
