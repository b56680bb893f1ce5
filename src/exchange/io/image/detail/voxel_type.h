#pragma once

#include <cstddef>
#include <cstdint>

namespace trocar::io::detail {

/// Type of the numbers that a file stores.
enum class VoxelType { kUInt8, kInt8, kUInt16, kInt16, kUInt32, kInt32, kUInt64, kInt64, kFloat, kDouble };

std::size_t bytes_per_voxel(VoxelType type) noexcept;

}  // namespace trocar::io::detail
