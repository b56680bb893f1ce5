#pragma once

#include "xray/projection/detail/row_stack.h"
#include "xray/projection/xray_volume.h"

namespace trocar::xray {

/// The volume's voxels twice: as rows along index axis 0, and along axis 1 for rays that advance along axis 0.
struct XrayVolume::Impl {
  volume::GridGeometry geometry;
  detail::RowStack<detail::PackedVoxel> rows, transposed;
  std::shared_ptr<const anatomy::VirtualPatient> patient;  ///< Empty for a CT alone.
};

}  // namespace trocar::xray
