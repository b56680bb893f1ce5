#pragma once

#include <array>
#include <cstdint>

#include "anatomy/patient.h"
#include "scene/volume_preset.h"

namespace trocar::scene::detail {

/// What a cloud leaves out of the CT; outside of the skin (table, blankets) all do.
enum class CloudContent {
  kWhole,
  kWithoutBone,  ///< Bone and cartilage of the segmentation are soft tissue: marrow is as dense as contrast.
  kWithoutGas,   ///< Gas inside is fat: its walls would look like skin.
};

CloudContent content_of(VolumePreset preset) noexcept;

/// Voxels in each direction that become one, so that edges are about even and the longest side has at most about
/// `most_voxels` of them.
std::array<std::int64_t, 3> cloud_steps(const volume::GridGeometry& ct, std::int64_t most_voxels) noexcept;

/// The CT (HU) in means of blocks of voxels (`steps`: 1 .. size); what is left over at the far borders is cut off.
volume::CtGrid make_cloud(const anatomy::VirtualPatient& patient, CloudContent content,
                          const std::array<std::int64_t, 3>& steps);

}  // namespace trocar::scene::detail
