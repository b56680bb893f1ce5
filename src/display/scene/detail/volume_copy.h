#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "anatomy/patient.h"
#include "scene/scene_options.h"

namespace trocar::scene::detail {

/// CT structures that a volume rendering omits; every rendering omits voxels outside of the skin (table, blankets).
enum class CloudContent {
  kWhole,
  kWithoutBone,  ///< Segmented bone and cartilage become soft tissue: marrow is as dense as contrast agent.
  kWithoutGas,   ///< Gas inside the body becomes fat: its walls would look like skin.
};

CloudContent content_of(VolumePreset preset) noexcept;

/// Number of voxels in each direction that are merged into one: its edges are about equal, and the longest side has at
/// most about `most_voxels` merged voxels.
std::array<std::int64_t, 3> cloud_steps(const volume::GridGeometry& ct, std::int64_t most_voxels) noexcept;

/// The CT (HU) as means of blocks of voxels (`steps`: 1 .. size); incomplete blocks at the far borders are dropped.
volume::CtGrid make_cloud(const anatomy::VirtualPatient& patient, CloudContent content,
                          const std::array<std::int64_t, 3>& steps);

/// Points near the skin (P, mm), some millimetres apart: what a camera shows before there are surfaces.
std::vector<Vec3> skin_points(const anatomy::VirtualPatient& patient);

}  // namespace trocar::scene::detail
