#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/result.h"
#include "volume/grid.h"

namespace trocar::dicom {

/// The CT that a segmentation has to belong to.
struct CtReference {
  volume::GridGeometry grid;
  std::string series_uid{};          ///< Empty if it is not known (a CT of another format), as the next two.
  std::string frame_of_reference{};  ///< UID.
  std::vector<Vec3> slices_P{};      ///< Centres of the first pixels of its slices in the files, along their normal.
  /// A segmentation of another series of the same scan (another reconstruction) is read, too, with a warning.
  bool accepts_sibling = false;
  std::string patient_id{};  ///< Compared, never displayed; empty if it is not known.
  /// Number of images of a series in the folder of the CT; empty if it comes from no folder. Called for an error only.
  std::function<std::size_t(const std::string& series_uid)> images_of_series{};
};

/// One structure of a segmentation, as its file describes it. Texts are UTF-8.
struct Segment {
  int number = 0;                    ///< SegmentNumber or ROINumber.
  std::string name;                  ///< SegmentLabel or ROIName.
  std::string type_in_region{};      ///< Region and property type together: "Liver Neoplasm". Empty without a region.
  std::vector<std::string> codes{};  ///< Of the type and the region: "SCT:64033007 left".
  std::vector<std::string> meanings{};  ///< The same in words: "Kidney left".
};

/// Structures that do not overlap.
struct SegmentVolume {
  volume::LabelGrid labels;           ///< 0, or n for the structure segments[n - 1].
  std::vector<std::size_t> segments;  ///< Indices into Segmentation::segments.
};

/// Structures with at least one voxel are in exactly one volume, others in none.
struct Segmentation {
  std::vector<Segment> segments;  ///< Those that are wanted.
  std::vector<SegmentVolume> volumes;
  std::vector<std::string> warnings;
};

enum class ObjectKind {
  kOther,         ///< No DICOM file, or another object.
  kSegmentation,  ///< DICOM SEG: binary, fractional or label map.
  kContours,      ///< RT structure set.
};

/// Tells by the SOP class what a file is. A damaged DICOM file is an error.
Result<ObjectKind> find_object_kind(const std::filesystem::path& path);

/// UIDs of the series that a segmentation or structure set refers to; none if it does not tell.
Result<std::vector<std::string>> referenced_series(const std::filesystem::path& path);

/// One compressed frame of `rows` x `columns` pixels of 8 or 16 bits (unsigned), or of one bit: then run-length coded,
/// eight pixels a byte. A decoder unpacks it into `out`, little endian.
struct CompressedFrame {
  std::span<const char> bytes;
  const std::string& transfer_syntax;
  int columns;
  int rows;
  int bits;
};
using FrameDecoder = std::function<Status(const CompressedFrame& frame, std::span<std::byte> out)>;

/// Reads a DICOM SEG or RT structure set; structures that are not wanted are left out, even unusable ones.
///
/// SEG: frames in any order and of any orientation, missing frames are empty planes (warning within a structure),
/// planes of a thicker scan fill their thickness, overlapping segments come in several volumes. A fractional pixel is
/// inside from half of the maximum on. The volumes are in the places of the frames, not on the CT's grid. RT structure
/// set: closed planar contours, on the CT's grid if they are parallel to one of its planes. Contours of one plane: one
/// inside another is a hole, those that cross are united (by even-odd if they are CLOSEDPLANAR_XOR), the same outline
/// counts once. A contour reaches half-way to its neighbours, wherever their planes
/// lie; wider gaps between separate parts stay empty (warning).
///
/// Errors: another series or frame of reference than the CT's, where both are known (CtReference::accepts_sibling);
/// open contours, not planar ones, numbers that are not those of one structure each, a structure in another frame of
/// reference; frames without a place or of a segment that is not defined, such numbers in a label
/// map; a structure with as many empty planes between as drawn ones; an unknown kind of pixels; a damaged file; not
/// enough memory.
Result<Segmentation> read_segmentation(const std::filesystem::path& path, const CtReference& ct,
                                       const std::function<bool(const Segment&)>& is_wanted,
                                       const FrameDecoder& decode = {});

}  // namespace trocar::dicom
