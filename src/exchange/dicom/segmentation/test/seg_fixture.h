#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>

#include "core/files/folders.h"
#include "dicom/segmentation/segmentation.h"
#include "dicom/testing/segmentation_writer.h"

// Small SEGs on a small CT.
namespace trocar::dicom::seg_test {

using trocar::testing::segment_item;
using trocar::testing::TestSeg;

/// A CT of 8 x 6 x 5 voxels of 1 x 1 x 2 mm.
inline CtReference ct_with_slices(const std::vector<double>& slices_mm = {0, 2, 4, 6, 8}) {
  CtReference ct;
  ct.grid.size = {8, 6, 5};
  ct.grid.spacing_mm = {1, 1, 2};
  ct.grid.origin_P = {-4, 10, 100};
  ct.series_uid = "1.2.3";
  ct.frame_of_reference = "1.2.9";
  for (const double z : slices_mm) ct.slices_P.push_back(ct.grid.origin_P + z * Vec3::UnitZ());
  return ct;
}

inline Vec3 at_z(double z_mm) {
  return Vec3(-4, 10, 100 + z_mm);
}

inline std::function<int(int, int)> block(int first_column, int last_column, int value = 1) {
  return [=](int i, int) { return i >= first_column && i <= last_column ? value : 0; };
}

inline bool every_segment(const Segment&) {
  return true;
}

class Seg : public ::testing::Test {
 protected:
  Result<Segmentation> read(const std::string& elements, const CtReference& ct = ct_with_slices()) {
    trocar::testing::write_dicom(folder_ / "label.seg", elements);
    return read_segmentation(folder_ / "label.seg", ct, every_segment);
  }
  Result<Segmentation> read(const TestSeg& seg, const CtReference& ct = ct_with_slices()) {
    return read(trocar::testing::seg_elements(seg), ct);
  }
  std::string error_of(const TestSeg& seg, const CtReference& ct = ct_with_slices()) {
    const auto segmentation = read(seg, ct);
    return segmentation ? "read" : segmentation.error().text();
  }
  TemporaryFolder folder_;
};

/// Voxel indices (z in mm from the first slice) of a segment, in any volume.
inline std::vector<std::array<double, 3>> voxels_of(const Segmentation& segmentation, std::size_t segment) {
  std::vector<std::array<double, 3>> voxels;
  for (const SegmentVolume& volume : segmentation.volumes)
    for (std::size_t n = 0; n < volume.labels.voxels.size(); ++n) {
      const std::uint8_t value = volume.labels.voxels[n];
      if (value == 0 || volume.segments.at(value - 1U) != segment) continue;
      const Vec3 p_P = volume.labels.geometry.centre_mm(volume.labels.geometry.index_of(n)) - at_z(0);
      voxels.push_back({p_P.x(), p_P.y(), p_P.z()});
    }
  return voxels;
}

inline std::size_t count_at(const std::vector<std::array<double, 3>>& voxels, double z_mm) {
  return static_cast<std::size_t>(
      std::count_if(voxels.begin(), voxels.end(), [&](const auto& v) { return std::abs(v[2] - z_mm) < 1e-6; }));
}

}  // namespace trocar::dicom::seg_test
