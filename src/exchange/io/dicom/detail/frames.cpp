#include "io/dicom/detail/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

namespace trocar::io::detail {
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
