#include "dicom/segmentation/segmentation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <new>

#include "core/available_memory.h"
#include "dicom/elements/dicom_file.h"
#include "dicom/segmentation/detail/contour_raster.h"
#include "dicom/segmentation/detail/contours.h"
#include "dicom/segmentation/detail/read_seg.h"
#include "dicom/segmentation/detail/seg_pixels.h"

namespace trocar::dicom::detail {

/// read_segmentation() of an RT structure set that belongs to the CT.
Result<Segmentation> read_structure_set(const DicomFile& file, const std::string& where, const CtReference& ct,
                                        const std::function<bool(const Segment&)>& is_wanted);

}  // namespace trocar::dicom::detail

namespace trocar::dicom {
namespace fs = std::filesystem;
namespace {

constexpr std::uint32_t kSopClass = tag(0x0008, 0x0016);
constexpr std::uint32_t kReferencedSeries = tag(0x0008, 0x1115);
constexpr std::uint32_t kFrameOfReference = tag(0x0020, 0x0052);
constexpr std::uint32_t kReferencedFrames = tag(0x3006, 0x0010);
constexpr std::uint32_t kReferencedStudies = tag(0x3006, 0x0012);
constexpr std::uint32_t kReferencedRtSeries = tag(0x3006, 0x0014);

// DICOM PS3.4, B.5.
constexpr std::string_view kSegmentationClass = "1.2.840.10008.5.1.4.1.1.66.4";
constexpr std::string_view kLabelMapClass = "1.2.840.10008.5.1.4.1.1.66.7";
constexpr std::string_view kSurfaceClass = "1.2.840.10008.5.1.4.1.1.66.5";
constexpr std::string_view kStructureSetClass = "1.2.840.10008.5.1.4.1.1.481.3";

/// What an object was drawn on.
struct Origin {
  std::vector<std::string> series;
  std::vector<std::string> frames_of_reference;
};

void add_text(const DicomItem& item, std::uint32_t tag, std::vector<std::string>& texts) {
  if (const std::string_view text = item.text(tag); !text.empty()) texts.push_back(to_utf8(text, "none"));
}

Result<Origin> origin_of(const DicomItem& root, ObjectKind kind) {
  Origin origin;
  if (kind == ObjectKind::kSegmentation) {
    add_text(root, kFrameOfReference, origin.frames_of_reference);
    TROCAR_TRY(const auto items, root.items(kReferencedSeries));
    for (const DicomItem& item : items) add_text(item, kSeriesUid, origin.series);
    return origin;
  }
  TROCAR_TRY(const auto frames, root.items(kReferencedFrames));
  for (const DicomItem& frame : frames) {
    add_text(frame, kFrameOfReference, origin.frames_of_reference);
    TROCAR_TRY(const auto studies, frame.items(kReferencedStudies));
    for (const DicomItem& study : studies) {
      TROCAR_TRY(const auto series, study.items(kReferencedRtSeries));
      for (const DicomItem& item : series) add_text(item, kSeriesUid, origin.series);
    }
  }
  return origin;
}

bool contains(const std::vector<std::string>& texts, const std::string& text) {
  return std::find(texts.begin(), texts.end(), text) != texts.end();
}

/// The error for an object of another series: that series may be at hand, be no volume, or be elsewhere.
tl::unexpected<Error> other_series(const Origin& origin, const CtReference& ct, bool is_same_frame,
                                   const std::string& where) {
  std::string series = origin.series.front();
  std::size_t images = 0;
  for (const std::string& uid : origin.series)
    if (const std::size_t count = ct.images_of_series ? ct.images_of_series(uid) : 0; count > images) {
      images = count;
      series = uid;
    }
  std::string what = fmt::format("was drawn on another series ({}), not on the CT's ({})", series, ct.series_uid);
  std::string advice = "give that series as the CT (--ct, --series UID)";
  if (ct.images_of_series && images < 2) {
    what += images == 0 ? "; that series is not in the folder of the CT"
                        : "; that series has only one image in the folder of the CT, which is no volume";
    advice = "give a folder with all images of that series as the CT (--ct)";
  }
  advice += is_same_frame ? ", or accept this CT, as both have the same frame of reference, by --sibling-series"
                          : ", or the segmentation of this CT";
  return fail(what, where, advice);
}

/// Compares what both files tell; what one of them lacks is not compared. Returns warnings.
Result<std::vector<std::string>> check_origin(const Origin& origin, const CtReference& ct, const std::string& where) {
  const bool has_frames = !ct.frame_of_reference.empty() && !origin.frames_of_reference.empty();
  const bool is_same_frame = has_frames && contains(origin.frames_of_reference, ct.frame_of_reference);
  std::vector<std::string> warnings;
  if (!ct.series_uid.empty() && !origin.series.empty() && !contains(origin.series, ct.series_uid)) {
    if (!is_same_frame || !ct.accepts_sibling) return other_series(origin, ct, is_same_frame, where);
    warnings.push_back(
        fmt::format("was drawn on the series {}, not on the CT's ({}): placed by their common frame of "
                    "reference ({})",
                    origin.series.front(), ct.series_uid, ct.frame_of_reference));
  }
  if (has_frames && !is_same_frame)
    return fail(fmt::format("has another frame of reference ({}) than the CT ({})", origin.frames_of_reference.front(),
                            ct.frame_of_reference),
                where, "give the segmentation that was drawn on this CT");
  return warnings;
}

Result<ObjectKind> kind_of(const DicomFile& file, const std::string& where) {
  if (file.is_deflated())
    return fail("deflated DICOM is not supported", where, "export it again as Explicit VR Little Endian");
  const std::string_view sop_class = file.root().text(kSopClass);
  if (sop_class == kSurfaceClass)
    return fail("is a DICOM surface segmentation, which has no voxels", where,
                "export it as DICOM SEG or as .seg.nrrd");
  if (sop_class == kSegmentationClass || sop_class == kLabelMapClass) return ObjectKind::kSegmentation;
  return sop_class == kStructureSetClass ? ObjectKind::kContours : ObjectKind::kOther;
}

/// A SEG or structure set with its kind; empty for anything else.
struct OpenedObject {
  DicomFile file;
  ObjectKind kind;
};

Result<std::optional<OpenedObject>> open_object(const fs::path& path) {
  TROCAR_TRY(std::optional<DicomFile> file, DicomFile::read(path));
  if (!file) return std::nullopt;
  TROCAR_TRY(const ObjectKind kind, kind_of(*file, path.string()));
  if (kind == ObjectKind::kOther) return std::nullopt;
  return OpenedObject{*std::move(file), kind};
}

}  // namespace

Result<ObjectKind> find_object_kind(const fs::path& path) {
  TROCAR_TRY(const auto object, open_object(path));
  return object ? object->kind : ObjectKind::kOther;
}

Result<std::vector<std::string>> referenced_series(const fs::path& path) {
  TROCAR_TRY(const auto object, open_object(path));
  if (!object) return std::vector<std::string>{};
  auto origin = origin_of(object->file.root(), object->kind);
  if (!origin) return fail(origin.error().what, path.string(), origin.error().advice);
  return std::move(origin->series);
}

Result<Segmentation> read_segmentation(const fs::path& path, const CtReference& ct,
                                       const std::function<bool(const Segment&)>& is_wanted,
                                       const FrameDecoder& decode) {
  const std::string where = path.string();
  TROCAR_TRY(const auto object, open_object(path));
  if (!object) return fail("is no DICOM segmentation or RT structure set", where, "give a SEG or RTSTRUCT file");
  const auto origin = origin_of(object->file.root(), object->kind);
  if (!origin) return fail(origin.error().what, where, origin.error().advice);
  TROCAR_TRY(const std::vector<std::string> warnings, check_origin(*origin, ct, where));
  try {
    auto read = object->kind == ObjectKind::kSegmentation
                    ? detail::read_seg(object->file, where, ct, is_wanted, decode)
                    : detail::read_structure_set(object->file, where, ct, is_wanted);
    if (read) read->warnings.insert(read->warnings.begin(), warnings.begin(), warnings.end());
    return read;
  } catch (const std::bad_alloc&) {
    return fail("not enough memory to read the segmentation", where, "close other programs");
  }
}

}  // namespace trocar::dicom

namespace trocar::dicom::detail {
namespace {

constexpr double kSparsePlanes = 3.5;    ///< Steps of the grid: more were drawn on by hand only here and there.
constexpr double kMostOutside_ml = 1.0;  ///< Of a structure beyond the CT without a warning.
constexpr double kMostCommon_ml = 0.05;  ///< In two contours of a plane without a warning.

std::string counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// What the contours leave open: gaps and the places between them.
void warn_of_distances(const std::string& name, const PlaneDistances& distances, double step_mm, bool is_on_ct,
                       std::vector<std::string>& warnings) {
  const std::string usual = fmt::format("; its planes are usually {:.1f} mm apart", distances.usual * step_mm);
  if (distances.filled_gaps > 0)
    warnings.push_back(fmt::format("\"{}\": {} between contours filled, of up to {:.1f} mm{}", name,
                                   counted(distances.filled_gaps, "gap"), distances.widest_filled * step_mm, usual));
  if (distances.open_gaps > 0)
    warnings.push_back(fmt::format("\"{}\": {} between contours left empty, of {:.1f} mm or more{}", name,
                                   counted(distances.open_gaps, "gap"), distances.narrowest_open * step_mm, usual));
  if (is_on_ct && distances.usual > kSparsePlanes)
    warnings.push_back(
        fmt::format("\"{}\": its contours are {:.1f} mm apart, the CT's slices {:.1f} mm: filled "
                    "half-way to the next contour",
                    name, distances.usual * step_mm, step_mm));
}

/// Contours of one plane whose meaning is not plain.
void warn_of_overlaps(const ContourStructure& structure, const RasterResult& raster,
                      std::vector<std::string>& warnings) {
  const std::string& name = structure.segment.name;
  if (raster.repeated > 0)
    warnings.push_back(fmt::format("\"{}\": {} left out, the same as another one of the plane", name,
                                   counted(raster.repeated, "contour")));
  if (raster.crossing_ml > kMostCommon_ml)
    warnings.push_back(fmt::format("\"{}\": {} of contours cross in their plane: the {:.1f} ml in both are {}", name,
                                   counted(raster.crossing, "pair"), raster.crossing_ml,
                                   structure.is_exclusive_or ? "outside (CLOSEDPLANAR_XOR)" : "inside"));
  if (raster.doubtful_ml > kMostCommon_ml)
    warnings.push_back(
        fmt::format("\"{}\": {} of {:.1f} ml left empty: contours inside others of their plane, but "
                    "across them or leaving only a thin ring; drawn twice?",
                    name, counted(raster.doubtful, "hole"), raster.doubtful_ml));
}

void warn_of(const ContourStructure& structure, const RasterResult& raster, const ContourGrid& grid, bool is_on_ct,
             std::vector<std::string>& warnings) {
  const std::string& name = structure.segment.name;
  if (structure.degenerate > 0)
    warnings.push_back(fmt::format("\"{}\": {} contours of one or two points left out", name, structure.degenerate));
  warn_of_overlaps(structure, raster, warnings);
  warn_of_distances(name, raster.distances, grid.geometry.spacing_mm[grid.axis], is_on_ct, warnings);
  if (raster.outside_ml > kMostOutside_ml)
    warnings.push_back(fmt::format("\"{}\": {:.0f} ml lie beyond the CT and are left out", name, raster.outside_ml));
}

/// The place of a structure in another frame of reference than the CT's, or than that of the other structures, is
/// unknown.
Status check_frames(const std::vector<ContourStructure>& structures, const CtReference& ct, const std::string& where) {
  std::string expected = ct.frame_of_reference;
  std::string owner = "the CT";
  for (const ContourStructure& structure : structures) {
    const std::string& frame = structure.frame_of_reference;
    if (frame.empty() || structure.contours.empty()) continue;
    if (expected.empty()) {
      expected = frame;
      owner = fmt::format("\"{}\"", structure.segment.name);
    } else if (frame != expected) {
      return fail(fmt::format("\"{}\" (number {}) is in another frame of reference ({}) than {} ({})",
                              structure.segment.name, structure.segment.number, frame, owner, expected),
                  where,
                  "draw it on this CT and export it again, or ignore it with ignore = [\"NAME\"] in a label map "
                  "(--label-map)");
    }
  }
  return {};
}

}  // namespace

Result<Segmentation> read_structure_set(const DicomFile& file, const std::string& where, const CtReference& ct,
                                        const std::function<bool(const Segment&)>& is_wanted) {
  TROCAR_TRY(const std::vector<ContourStructure> structures, read_contours(file, where, is_wanted));
  TROCAR_TRY_STATUS(check_frames(structures, ct, where));
  TROCAR_TRY_STATUS(check_memory_for_image(ct.grid.voxel_count(), available_memory_bytes(), where));
  Segmentation result;
  LabelLayers on_ct(ct.grid.size, where);
  for (const ContourStructure& structure : structures) {
    const std::size_t index = result.segments.size();
    result.segments.push_back(structure.segment);
    if (structure.contours.empty()) continue;
    TROCAR_TRY(const ContourGrid grid, choose_grid(structure, ct.grid, where));
    const RasterResult raster = rasterise(structure, grid);
    const bool is_on_ct = grid.geometry.matches(ct.grid);
    warn_of(structure, raster, grid, is_on_ct, result.warnings);
    if (is_on_ct) {
      TROCAR_TRY_STATUS(on_ct.add(index, 0, raster.mask));
      continue;
    }
    LabelLayers own(grid.geometry.size, where);
    TROCAR_TRY_STATUS(own.add(index, 0, raster.mask));
    for (LabelLayers::Layer& layer : own.take()) {
      volume::LabelGrid labels;
      labels.geometry = grid.geometry;
      labels.voxels = std::move(layer.voxels);
      result.volumes.push_back({std::move(labels), std::move(layer.segments)});
    }
  }
  for (LabelLayers::Layer& layer : on_ct.take()) {
    volume::LabelGrid labels;
    labels.geometry = ct.grid;
    labels.voxels = std::move(layer.voxels);
    result.volumes.push_back({std::move(labels), std::move(layer.segments)});
  }
  return result;
}

}  // namespace trocar::dicom::detail
