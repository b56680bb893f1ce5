#include "dicom/segmentation/detail/read_seg.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "core/available_memory.h"
#include "dicom/segmentation/detail/plane_places.h"
#include "dicom/segmentation/detail/seg_pixels.h"

namespace trocar::dicom::detail {
namespace {

/// Voxels of the grid, empty planes included, for each voxel of the CT or pixel of the file: bounds the memory.
constexpr std::uint64_t kMostEmptiness = 16;

/// A segment with pixels, but none inside.
struct FaintSegment {
  std::size_t index = 0;
  int highest = 0;  ///< Of its pixels.
};

/// The frames of a SEG on their planes.
class SegPainter {
 public:
  SegPainter(const SegHeader& header, const SegPlanes& planes, const SegPixels& pixels, std::string where)
      : header_(header),
        planes_(planes),
        pixels_(pixels),
        layers_({header.columns, header.rows, static_cast<std::int64_t>(planes.stack.origins_P.size())},
                std::move(where)) {}

  /// One segment of a binary or fractional SEG.
  Status add_segment(std::size_t index, int number) {
    std::vector<std::size_t> frames;
    for (std::size_t n = 0; n < header_.frames.size(); ++n)
      if (header_.frames[n].segment == number) frames.push_back(n);
    return add_frames(index, frames);
  }

  std::vector<LabelLayers::Layer> take() { return layers_.take(); }
  /// Fractional segments that reach half of the maximum nowhere.
  const std::vector<FaintSegment>& faint() const { return faint_; }
  /// Segments, and frames of each that differ from another one of their plane.
  const std::vector<std::pair<std::size_t, std::size_t>>& repeated() const { return repeated_; }

 private:
  /// Half of the maximum, or more; 1 bit is all or nothing.
  bool is_inside(std::uint16_t value) const {
    if (header_.type != SegmentationType::kFractional) return value != 0;
    return 2 * static_cast<int>(value) >= header_.maximum_fractional;
  }

  /// The frame that is read shows something else than an earlier one of its plane; an empty one tells nothing.
  bool differs(std::span<const std::uint8_t> before) const {
    bool any_before = false, any_now = false, is_other = false;
    for (std::size_t n = 0; n < before.size(); ++n) {
      const bool now = is_inside(numbers_[n]);
      any_before = any_before || before[n] != 0;
      any_now = any_now || now;
      is_other = is_other || now != (before[n] != 0);
    }
    return any_before && any_now && is_other;
  }

  Status add_frames(std::size_t index, const std::vector<std::size_t>& frames) {
    if (frames.empty()) return {};
    const auto [low, high] = std::minmax_element(frames.begin(), frames.end(), [&](std::size_t a, std::size_t b) {
      return planes_.plane_of_frame[a] < planes_.plane_of_frame[b];
    });
    const std::size_t first = planes_.plane_of_frame[*low];
    const std::size_t count = planes_.plane_of_frame[*high] - first + 1;
    const auto plane_size = static_cast<std::size_t>(header_.columns) * static_cast<std::size_t>(header_.rows);
    std::vector<std::uint8_t> mask(count * plane_size, 0);
    std::vector<bool> is_shown(count, false);
    std::size_t contradictions = 0;
    std::uint16_t highest = 0;
    for (const std::size_t frame : frames) {
      TROCAR_TRY_STATUS(pixels_.read(frame, numbers_));
      const std::size_t plane = planes_.plane_of_frame[frame] - first;
      const std::span<std::uint8_t> out = std::span(mask).subspan(plane * plane_size, plane_size);
      if (is_shown[plane] && differs(out)) ++contradictions;
      is_shown[plane] = true;
      for (std::size_t n = 0; n < plane_size; ++n)
        if (is_inside(numbers_[n])) out[n] = 1;
      highest = std::max(highest, *std::max_element(numbers_.begin(), numbers_.end()));
    }
    if (contradictions > 0) repeated_.push_back({index, contradictions});
    if (highest > 0 && !is_inside(highest)) faint_.push_back({index, highest});
    return layers_.add(index, static_cast<std::int64_t>(first), mask);
  }

  const SegHeader& header_;
  const SegPlanes& planes_;
  const SegPixels& pixels_;
  LabelLayers layers_;
  std::vector<std::uint16_t> numbers_;
  std::vector<FaintSegment> faint_;
  std::vector<std::pair<std::size_t, std::size_t>> repeated_;
};

constexpr std::size_t kPixelNumbers = 1 << 16;

/// Pixels of each number in a label map. Error: numbers without a segment, other than the background.
Result<std::vector<std::size_t>> count_numbers(const SegHeader& header, const SegPixels& pixels,
                                               const std::string& where) {
  std::vector<std::size_t> counts(kPixelNumbers, 0);
  std::vector<std::uint16_t> numbers;
  for (std::size_t frame = 0; frame < header.frames.size(); ++frame) {
    TROCAR_TRY_STATUS(pixels.read(frame, numbers));
    for (const std::uint16_t number : numbers) ++counts[number];
  }
  std::vector<bool> is_defined(kPixelNumbers, false);
  for (const Segment& segment : header.segments) is_defined[static_cast<std::uint16_t>(segment.number)] = true;
  for (std::size_t number = 1; number < counts.size(); ++number)
    if (counts[number] > 0 && !is_defined[number] && static_cast<int>(number) != header.padding)
      return fail(fmt::format("{} pixels have the number {}, which the DICOM segmentation does not define as a segment",
                              counts[number], number),
                  where, kExportSegmentationAgain);
  return counts;
}

/// The wanted segments of a label map in volumes of at most 255; they cannot overlap. Reads the frames twice: to find
/// the segments that occur, and to paint them.
Result<std::vector<LabelLayers::Layer>> read_label_map(const SegHeader& header, const SegPlanes& planes,
                                                       const SegPixels& pixels, const std::vector<Segment>& segments,
                                                       const std::string& where) {
  TROCAR_TRY(const std::vector<std::size_t> counts, count_numbers(header, pixels, where));
  std::vector<std::uint16_t> numbers;
  const auto plane_size = static_cast<std::size_t>(header.columns) * static_cast<std::size_t>(header.rows);
  const std::size_t voxels = plane_size * planes.stack.origins_P.size();
  std::vector<LabelLayers::Layer> layers;
  for (std::size_t next = 0; next < segments.size();) {
    TROCAR_TRY_STATUS(check_memory_for_image(voxels, available_memory_bytes(), where));
    LabelLayers::Layer layer{std::vector<std::uint8_t>(voxels, 0), {}};
    std::vector<std::uint8_t> value_of(kPixelNumbers, 0);
    for (; next < segments.size() && layer.segments.size() < kMostValues; ++next) {
      const auto number = static_cast<std::uint16_t>(segments[next].number);
      if (counts[number] == 0) continue;
      layer.segments.push_back(next);
      value_of[number] = static_cast<std::uint8_t>(layer.segments.size());
    }
    for (std::size_t frame = 0; frame < header.frames.size(); ++frame) {
      TROCAR_TRY_STATUS(pixels.read(frame, numbers));
      std::uint8_t* out = layer.voxels.data() + planes.plane_of_frame[frame] * plane_size;
      for (std::size_t n = 0; n < plane_size; ++n)
        if (const std::uint8_t value = value_of[numbers[n]]; value != 0) out[n] = value;
    }
    if (!layer.segments.empty()) layers.push_back(std::move(layer));
  }
  return layers;
}

void warn_of_planes(const SegPlanes& planes, const StackPlan& plan, std::vector<std::string>& warnings) {
  if (planes.thick)
    warnings.push_back(
        fmt::format("its planes are {:.2f} mm thick, the CT's slices {:.2f} mm apart: each plane fills its thickness",
                    planes.thick->thickness_mm, planes.thick->ct_step_mm));
  if (plan.is_plain) return;
  warnings.push_back(fmt::format("the planes of the segmentation are {}: resampled by the nearest plane",
                                 plan.is_uneven ? "at uneven distances" : "tilted"));
}

constexpr std::size_t kFewGaps = 2;        ///< Forgotten planes.
constexpr std::size_t kMostNamedGaps = 4;  ///< Structures in one line.

/// Planes that are left empty are told; a structure of stripes is refused.
Status check_gaps(const std::vector<LabelLayers::Layer>& layers, const SliceStack& stack,
                  const std::vector<Segment>& segments, const std::string& where, std::vector<std::string>& warnings) {
  std::vector<std::string> striped;
  for (const LabelLayers::Layer& layer : layers) {
    const std::vector<PlaneGaps> gaps = find_plane_gaps(layer, stack);
    for (std::size_t n = 0; n < gaps.size(); ++n) {
      if (gaps[n].count == 0) continue;
      const std::string& name = segments[layer.segments[n]].name;
      const std::string between = fmt::format("{} between {} planes, up to {:.1f} mm from plane to plane",
                                              gaps[n].count == 1 ? "1 gap" : fmt::format("{} gaps", gaps[n].count),
                                              gaps[n].drawn, gaps[n].widest_mm);
      if (gaps[n].count > kFewGaps && 2 * gaps[n].count > gaps[n].drawn)
        striped.push_back(fmt::format("\"{}\" ({})", name, between));
      else
        warnings.push_back(fmt::format("\"{}\": left empty: {}", name, between));
    }
  }
  if (striped.empty()) return {};
  if (striped.size() > kMostNamedGaps) {
    const std::size_t more = striped.size() - kMostNamedGaps;
    striped.resize(kMostNamedGaps);
    striped.push_back(fmt::format("{} more", more));
  }
  return fail(fmt::format("is drawn on some planes only, with empty ones between: {}", fmt::join(striped, ", ")), where,
              "fill between the planes in the program that drew them, and export again");
}

/// Shows the planes of a thicker scan on all slices that they fill.
void repeat_planes(const SegPlanes& planes, std::vector<LabelLayers::Layer>& layers) {
  const std::int64_t plane_size = planes.stack.columns * planes.stack.rows;
  for (LabelLayers::Layer& layer : layers)
    for (const PlaneRepeat& repeat : planes.repeats)
      std::copy_n(layer.voxels.begin() + static_cast<std::int64_t>(repeat.from) * plane_size, plane_size,
                  layer.voxels.begin() + static_cast<std::int64_t>(repeat.to) * plane_size);
}

/// Told by their numbers, instead of as empty; refused if nothing else is left.
Status check_faint(const std::vector<FaintSegment>& faint, const SegHeader& header,
                   const std::vector<Segment>& segments, bool any_inside, const std::string& where,
                   std::vector<std::string>& warnings) {
  for (const FaintSegment& segment : faint) {
    const std::string what =
        fmt::format("the fractions of \"{}\" are at most {} of {}: a pixel is inside from half of it on",
                    segments[segment.index].name, segment.highest, header.maximum_fractional);
    if (!any_inside) return fail(what, where, "export it as a binary segmentation, or with its true maximum");
    warnings.push_back(what);
  }
  return {};
}

Result<std::vector<LabelLayers::Layer>> read_layers(const SegHeader& header, const SegPlanes& planes,
                                                    const SegPixels& pixels, const std::vector<Segment>& segments,
                                                    const std::string& where, std::vector<std::string>& warnings) {
  if (header.type == SegmentationType::kLabelMap) return read_label_map(header, planes, pixels, segments, where);
  SegPainter painter(header, planes, pixels, where);
  for (std::size_t index = 0; index < segments.size(); ++index)
    TROCAR_TRY_STATUS(painter.add_segment(index, segments[index].number));
  for (const auto& [index, frames] : painter.repeated())
    warnings.push_back(fmt::format("\"{}\": {} of a plane that another one shows otherwise: the union counts",
                                   segments[index].name, frames == 1 ? "1 frame" : fmt::format("{} frames", frames)));
  std::vector<LabelLayers::Layer> layers = painter.take();
  TROCAR_TRY_STATUS(check_faint(painter.faint(), header, segments, !layers.empty(), where, warnings));
  return layers;
}

}  // namespace

Result<Segmentation> read_seg(const DicomFile& file, const std::string& where, const CtReference& ct,
                              const std::function<bool(const Segment&)>& is_wanted, const FrameDecoder& decode) {
  TROCAR_TRY(const SegHeader header, read_seg_header(file, where));
  TROCAR_TRY(const SegPixels pixels, SegPixels::open(file, header, decode, where));
  TROCAR_TRY(const SegPlanes planes, place_planes(header, ct, where));
  const auto found = plan_stack(planes.stack, planes.single_step_mm);
  if (!found)
    return fail("the frames of the DICOM segmentation are too far apart for one scan", where, kExportSegmentationAgain);
  const StackPlan& plan = *found;
  // The pixels are there, so that only empty planes between distant frames can be many.
  const auto bytes = static_cast<std::uint64_t>(plan.geometry.voxel_count());
  const std::uint64_t stored = static_cast<std::uint64_t>(header.frames.size()) *
                               static_cast<std::uint64_t>(header.columns) * static_cast<std::uint64_t>(header.rows);
  if (bytes > kMostEmptiness * std::max<std::uint64_t>(stored, ct.grid.voxel_count()))
    return fail("the frames of the DICOM segmentation are too far apart for this CT", where, kExportSegmentationAgain);
  TROCAR_TRY_STATUS(check_memory_for_image(bytes, available_memory_bytes(), where));

  Segmentation result;
  std::copy_if(header.segments.begin(), header.segments.end(), std::back_inserter(result.segments), is_wanted);
  TROCAR_TRY(std::vector<LabelLayers::Layer> layers,
             read_layers(header, planes, pixels, result.segments, where, result.warnings));
  repeat_planes(planes, layers);
  warn_of_planes(planes, plan, result.warnings);
  TROCAR_TRY_STATUS(check_gaps(layers, planes.stack, result.segments, where, result.warnings));
  for (LabelLayers::Layer& layer : layers)
    result.volumes.push_back(
        {fill_from_stack<std::uint8_t>(plan, planes.stack, std::move(layer.voxels), 0), std::move(layer.segments)});
  return result;
}

}  // namespace trocar::dicom::detail
