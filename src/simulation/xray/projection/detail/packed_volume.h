#pragma once

#include "motion/patient_motion.h"
#include "xray/projection/detail/row_stack.h"
#include "xray/projection/xray_volume.h"

namespace trocar::xray {

/// The volume's voxels twice: as rows along index axis 0, and along axis 1 for rays that advance along axis 0.
struct XrayVolume::Impl {
  volume::GridGeometry geometry;
  detail::RowStack<detail::PackedVoxel> rows, transposed;
  std::shared_ptr<const anatomy::VirtualPatient> patient;  ///< Empty for a CT alone.
  motion::PatientMotion motion;                            ///< Where the patient is in this volume.

  /// Builds both from `voxel(offset)`.
  template <class Voxel>
  void fill(const Voxel& voxel) {
    const auto [i, j, k] = geometry.size;
    rows = detail::make_row_stack<detail::PackedVoxel>(
        i, j, k, [&, size_i = i, size_j = j](std::int64_t x, std::int64_t a, std::int64_t b) {
          return voxel(static_cast<std::size_t>((b * size_j + a) * size_i + x));
        });
    transposed = detail::make_row_stack<detail::PackedVoxel>(
        j, i, k, [&, size_i = i, size_j = j](std::int64_t x, std::int64_t a, std::int64_t b) {
          return voxel(static_cast<std::size_t>((b * size_j + x) * size_i + a));
        });
  }
};

}  // namespace trocar::xray
