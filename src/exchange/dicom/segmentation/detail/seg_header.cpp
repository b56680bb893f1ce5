#include "dicom/segmentation/detail/seg_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace trocar::dicom::detail {
namespace {

constexpr std::uint32_t kCodeValue = tag(0x0008, 0x0100);
constexpr std::uint32_t kCodingScheme = tag(0x0008, 0x0102);
constexpr std::uint32_t kCodeMeaning = tag(0x0008, 0x0104);
constexpr std::uint32_t kRegion = tag(0x0008, 0x2218);
constexpr std::uint32_t kRegionModifier = tag(0x0008, 0x2220);
constexpr std::uint32_t kSliceThickness = tag(0x0018, 0x0050);
constexpr std::uint32_t kSpacingBetweenSlices = tag(0x0018, 0x0088);
constexpr std::uint32_t kPosition = tag(0x0020, 0x0032);
constexpr std::uint32_t kOrientation = tag(0x0020, 0x0037);
constexpr std::uint32_t kPlanePosition = tag(0x0020, 0x9113);
constexpr std::uint32_t kPlaneOrientation = tag(0x0020, 0x9116);
constexpr std::uint32_t kNumberOfFrames = tag(0x0028, 0x0008);
constexpr std::uint32_t kRows = tag(0x0028, 0x0010);
constexpr std::uint32_t kColumns = tag(0x0028, 0x0011);
constexpr std::uint32_t kPixelSpacing = tag(0x0028, 0x0030);
constexpr std::uint32_t kBitsAllocated = tag(0x0028, 0x0100);
constexpr std::uint32_t kPixelPadding = tag(0x0028, 0x0120);
constexpr std::uint32_t kPixelMeasures = tag(0x0028, 0x9110);
constexpr std::uint32_t kSegmentationType = tag(0x0062, 0x0001);
constexpr std::uint32_t kSegments = tag(0x0062, 0x0002);
constexpr std::uint32_t kCategory = tag(0x0062, 0x0003);
constexpr std::uint32_t kSegmentNumber = tag(0x0062, 0x0004);
constexpr std::uint32_t kSegmentLabel = tag(0x0062, 0x0005);
constexpr std::uint32_t kSegmentIdentification = tag(0x0062, 0x000a);
constexpr std::uint32_t kReferencedSegment = tag(0x0062, 0x000b);
constexpr std::uint32_t kMaximumFractional = tag(0x0062, 0x000e);
constexpr std::uint32_t kPropertyType = tag(0x0062, 0x000f);
constexpr std::uint32_t kPropertyModifier = tag(0x0062, 0x0011);
constexpr std::uint32_t kSharedGroups = tag(0x5200, 0x9229);
constexpr std::uint32_t kFrameGroups = tag(0x5200, 0x9230);

constexpr double kMaxSkew = 1e-3;        ///< Accepted as rounding in a file: 0.06 degrees.
constexpr double kMaxSpread_mm = 0.2;    ///< Between the last pixels of two frames, by the rounding of their spacing.
constexpr double kMaxStepChange = 0.01;  ///< Of a thickness: rounding.
constexpr int kMostFrames = 1 << 20;     ///< As many as items of a sequence.

/// " left", " right" or nothing, by the modifier of a code.
std::string side_of(const DicomItem& code, std::uint32_t modifier) {
  const auto item = code.first_item(modifier);
  if (!item) return {};
  const std::string_view value = item->text(kCodeValue);
  const std::string_view meaning = item->text(kCodeMeaning);
  // DICOM PS3.16, CID 244 (laterality).
  if (value == "7771000" || value == "G-A101" || meaning == "Left") return " left";
  if (value == "24028007" || value == "G-A100" || meaning == "Right") return " right";
  return {};
}

struct CodedName {
  std::string meaning;
  std::string code;
};

std::optional<CodedName> coded_name(const DicomItem& item, std::uint32_t sequence, std::uint32_t modifier,
                                    std::string_view character_set) {
  const auto code = item.first_item(sequence);
  if (!code) return std::nullopt;
  std::string side = side_of(*code, modifier);
  if (side.empty()) side = side_of(item, modifier);  // the modifier is beside the code in some objects
  return CodedName{to_utf8(code->text(kCodeMeaning), character_set) + side,
                   fmt::format("{}:{}{}", to_utf8(code->text(kCodingScheme), "none"),
                               to_utf8(code->text(kCodeValue), "none"), side)};
}

Segment read_segment(const DicomItem& item, std::string_view character_set) {
  Segment segment;
  segment.number = item.number(kSegmentNumber).value_or(0);
  segment.name = to_utf8(item.text(kSegmentLabel), character_set);
  const auto type = coded_name(item, kPropertyType, kPropertyModifier, character_set);
  const auto region = coded_name(item, kRegion, kRegionModifier, character_set);
  const auto category = coded_name(item, kCategory, 0, character_set);
  // A lesion in an organ is no part of the organ: SCT 49755003, SRT M-01000 (morphologically altered structure).
  const bool is_altered = category && (category->code == "SCT:49755003" || category->code == "SRT:M-01000");
  if (type && region) segment.type_in_region = region->meaning + " " + type->meaning;
  if (type) segment.meanings.push_back(type->meaning);
  if (region && !is_altered) segment.meanings.push_back(region->meaning);
  if (type) segment.codes.push_back(type->code);
  if (region && !is_altered) segment.codes.push_back(region->code);
  return segment;
}

Status read_segments(const DicomItem& root, SegHeader& header, const std::string& where) {
  const std::string character_set(root.text(kCharacterSet));
  const auto items = root.items(kSegments);
  if (!items) return fail(items.error().what, where, items.error().advice);
  std::set<int> numbers;
  for (const DicomItem& item : *items) {
    Segment segment = read_segment(item, character_set);
    if (segment.number == 0 && header.type == SegmentationType::kLabelMap) continue;  // the background
    if (!numbers.insert(segment.number).second)
      return fail(fmt::format("two segments have the number {}", segment.number), where, kExportSegmentationAgain);
    header.segments.push_back(std::move(segment));
  }
  if (header.segments.empty()) return fail("the DICOM segmentation names no segment", where, kExportSegmentationAgain);
  return {};
}

Status read_pixels(const DicomItem& root, SegHeader& header, const std::string& where) {
  const std::string_view type = root.text(kSegmentationType);
  if (type == "BINARY")
    header.type = SegmentationType::kBinary;
  else if (type == "FRACTIONAL")
    header.type = SegmentationType::kFractional;
  else if (type == "LABELMAP")
    header.type = SegmentationType::kLabelMap;
  else
    return fail(fmt::format("is a DICOM segmentation of the unknown type \"{}\"", to_utf8(type, "none")), where,
                kExportSegmentationAgain);
  header.columns = root.number(kColumns).value_or(0);
  header.rows = root.number(kRows).value_or(0);
  header.bits = root.number(kBitsAllocated).value_or(1);
  header.padding = root.number(kPixelPadding);
  header.maximum_fractional = root.number(kMaximumFractional).value_or(255);
  const bool is_known = (header.bits == 1 && header.type == SegmentationType::kBinary) || header.bits == 8 ||
                        (header.bits == 16 && header.type == SegmentationType::kLabelMap);
  if (header.columns < 1 || header.rows < 1 || !is_known || header.maximum_fractional < 1)
    return fail(
        fmt::format("the DICOM segmentation has {}x{} pixels of {} bits", header.columns, header.rows, header.bits),
        where, kExportSegmentationAgain);
  return {};
}

/// The item of a functional group: of the frame, or shared by all.
std::optional<DicomItem> group_of(const DicomItem& frame, const std::optional<DicomItem>& shared, std::uint32_t group) {
  if (auto own = frame.first_item(group)) return own;
  return shared ? shared->first_item(group) : std::nullopt;
}

std::optional<Vec3> point_of(const std::vector<double>& numbers, std::size_t at, std::size_t count) {
  if (numbers.size() != count) return std::nullopt;
  return Vec3(numbers[at], numbers[at + 1], numbers[at + 2]);
}

/// Where the pixels of a frame lie, but for its position.
struct FrameGrid {
  Vec3 row_P = Vec3::UnitX();
  Vec3 column_P = Vec3::UnitY();
  Eigen::Vector2d spacing_mm{1, 1};  ///< Between rows first, as in DICOM.
  std::optional<double> slice_step_mm, thickness_mm;
};

Result<FrameGrid> read_grid(const DicomItem& frame, const std::optional<DicomItem>& shared, const std::string& where) {
  const auto orientation = group_of(frame, shared, kPlaneOrientation);
  const auto measures = group_of(frame, shared, kPixelMeasures);
  const auto numbers = orientation ? orientation->decimals(kOrientation) : std::vector<double>();
  const auto row_P = point_of(numbers, 0, 6);
  const auto column_P = point_of(numbers, 3, 6);
  const auto spacing = measures ? measures->decimals(kPixelSpacing) : std::vector<double>();
  if (!row_P || !column_P || spacing.size() != 2)
    return fail("the DICOM segmentation has no position in the patient", where, kExportSegmentationAgain);
  const bool is_square = std::abs(row_P->norm() - 1.0) < kMaxSkew && std::abs(column_P->norm() - 1.0) < kMaxSkew &&
                         std::abs(row_P->dot(*column_P)) < kMaxSkew;
  if (!is_square || spacing[0] <= 0.0 || spacing[1] <= 0.0)
    return fail("the directions or the pixel spacing of the DICOM segmentation are none", where,
                kExportSegmentationAgain);
  const auto positive = [&](std::uint32_t tag) -> std::optional<double> {
    const auto values = measures->decimals(tag);
    if (values.size() != 1 || std::abs(values[0]) < 1e-3) return std::nullopt;
    return std::abs(values[0]);
  };
  return FrameGrid{
      *row_P, *column_P, {spacing[0], spacing[1]}, positive(kSpacingBetweenSlices), positive(kSliceThickness)};
}

void take_grid(const FrameGrid& grid, SegHeader& header) {
  header.row_P = grid.row_P.normalized();
  header.column_P = (grid.column_P - grid.column_P.dot(header.row_P) * header.row_P).normalized();
  header.row_step_mm = grid.spacing_mm.x();
  header.column_step_mm = grid.spacing_mm.y();
  header.slice_step_mm = grid.slice_step_mm;
  header.thickness_mm = grid.thickness_mm;
}

/// All frames have the directions and the spacing of the first one; a thickness that differs is none that all have.
Status check_grid(const FrameGrid& grid, const FrameGrid& first, SegHeader& header, const std::string& where) {
  if ((grid.row_P - first.row_P).norm() >= 2 * kMaxSkew || (grid.column_P - first.column_P).norm() >= 2 * kMaxSkew)
    return fail("the frames of the DICOM segmentation have several directions", where, kExportSegmentationAgain);
  const double extent_px = std::max(header.columns, header.rows);
  if ((grid.spacing_mm - first.spacing_mm).cwiseAbs().maxCoeff() * extent_px > kMaxSpread_mm)
    return fail(fmt::format("frame {} of the DICOM segmentation has pixels of {} x {} mm, the first one of {} x {} mm",
                            header.frames.size() + 1, grid.spacing_mm.y(), grid.spacing_mm.x(), first.spacing_mm.y(),
                            first.spacing_mm.x()),
                where, kExportSegmentationAgain);
  const auto is_same = [](const std::optional<double>& a, const std::optional<double>& b) {
    return a.has_value() == b.has_value() && (!a || std::abs(*a - *b) <= kMaxStepChange * *b);
  };
  if (!is_same(grid.slice_step_mm, first.slice_step_mm)) header.slice_step_mm.reset();
  if (!is_same(grid.thickness_mm, first.thickness_mm)) header.thickness_mm.reset();
  return {};
}

Status read_frames(const DicomItem& root, SegHeader& header, const std::string& where) {
  const auto shared = root.first_item(kSharedGroups);
  const auto items = root.items(kFrameGroups);
  if (!items) return fail(items.error().what, where, items.error().advice);
  const auto count = root.decimals(kNumberOfFrames);
  if (count.size() != 1 || count[0] < 1 || count[0] > kMostFrames ||
      static_cast<std::size_t>(count[0]) != items->size())
    return fail(fmt::format("the DICOM segmentation describes {} frames, not those of its header", items->size()),
                where, kExportSegmentationAgain);
  TROCAR_TRY(const FrameGrid first, read_grid(items->front(), shared, where));
  take_grid(first, header);
  for (const DicomItem& item : *items) {
    TROCAR_TRY(const FrameGrid grid, read_grid(item, shared, where));
    TROCAR_TRY_STATUS(check_grid(grid, first, header, where));
    const auto place = group_of(item, shared, kPlanePosition);
    const auto origin_P = place ? point_of(place->decimals(kPosition), 0, 3) : std::nullopt;
    if (!origin_P)
      return fail(fmt::format("frame {} of the DICOM segmentation has no position", header.frames.size() + 1), where,
                  kExportSegmentationAgain);
    const auto segment = group_of(item, shared, kSegmentIdentification);
    header.frames.push_back({segment ? segment->number(kReferencedSegment).value_or(0) : 0, *origin_P});
  }
  return {};
}

/// Frames of a segment without a description would be left out, whatever they show.
Status check_segments(const SegHeader& header, const std::string& where) {
  if (header.type == SegmentationType::kLabelMap) return {};  // its pixels are the numbers
  std::map<int, std::size_t> frames_of;
  for (const SegFrame& frame : header.frames) ++frames_of[frame.segment];
  for (const Segment& segment : header.segments) frames_of.erase(segment.number);
  if (frames_of.empty()) return {};
  const auto& [number, count] = *frames_of.begin();
  const std::string frames = count == 1 ? "1 frame" : fmt::format("{} frames", count);
  const std::string others = frames_of.size() > 1 ? fmt::format(" (and {} more)", frames_of.size() - 1) : "";
  if (number == 0)
    return fail(fmt::format("{} of the DICOM segmentation without the number of a segment{}", frames, others), where,
                kExportSegmentationAgain);
  return fail(fmt::format("{} of the segment number {}, which the DICOM segmentation does not define{}", frames, number,
                          others),
              where, kExportSegmentationAgain);
}

}  // namespace

Result<SegHeader> read_seg_header(const DicomFile& file, const std::string& where) {
  SegHeader header;
  const DicomItem root = file.root();
  TROCAR_TRY_STATUS(read_pixels(root, header, where));
  TROCAR_TRY_STATUS(read_segments(root, header, where));
  TROCAR_TRY_STATUS(read_frames(root, header, where));
  TROCAR_TRY_STATUS(check_segments(header, where));
  return header;
}

}  // namespace trocar::dicom::detail
