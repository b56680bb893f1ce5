#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <new>

#include "dicom/segmentation/detail/read_seg.h"
#include "dicom/segmentation/detail/read_structure_set.h"
#include "dicom/segmentation/segmentation.h"

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
