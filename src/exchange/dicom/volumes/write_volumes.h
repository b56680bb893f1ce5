#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "volume/grid.h"

namespace trocar::dicom {

/// Whom and what a written volume belongs to. UIDs: make_identity().
struct VolumeIdentity {
  std::string patient_name = "ANONYMOUS^";
  std::string patient_id = "ANONYMOUS";
  std::string study_uid, ct_series_uid, segmentation_series_uid, frame_of_reference;
  std::vector<std::string> slice_uids;  ///< Instances of the CT, one for each slice.
};

/// An anonymous patient with new, random UIDs, for a CT of so many slices.
VolumeIdentity make_identity(std::int64_t slices);

/// Writes a CT as one file a slice, "ct_0001.dcm" … (CT Image, PS3.3 A.3): 16 bits, signed, HU. Frame P (LPS, mm).
/// Errors: more than 65,535 rows or columns, another number of slices than in the identity; the file system's.
Status write_ct_series(const volume::CtGrid& ct, const VolumeIdentity& identity, const std::filesystem::path& folder,
                       const Progress& progress = {});

/// A structure to write: its voxels have the value `number` in the label volume, or are 1 in a mask of its own.
struct WrittenSegment {
  int number = 1;
  std::string name;
  std::string code, meaning;  ///< SNOMED CT of the property type; empty: "Tissue".
  std::string side;           ///< "Left", "Right" or empty.
};

/// Writes segments as a binary DICOM SEG (PS3.3, A.51) that refers to the CT's series: a frame for each slice of each
/// segment that has voxels in it. Errors: no segment has a voxel; those of write_ct_series().
Status write_segmentation(const volume::LabelGrid& labels, const std::vector<WrittenSegment>& segments,
                          const VolumeIdentity& identity, const std::filesystem::path& path);

}  // namespace trocar::dicom
