#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/files/folders.h"
#include "core/testing/test_data.h"
#include "volume/grid.h"

namespace trocar::testing {

inline std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline void write_bytes(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// A rotated grid with three different spacings and sizes.
inline volume::GridGeometry oblique_geometry() {
  volume::GridGeometry g;
  g.size = {7, 5, 4};
  g.spacing_mm = {0.7, 1.1, 2.5};
  g.origin_P = {-31.25, 12.5, 104.0};
  g.R_PV = (Eigen::AngleAxisd(0.4, Vec3::UnitZ()) * Eigen::AngleAxisd(-0.3, Vec3::UnitX())).toRotationMatrix();
  return g;
}

/// 0, 1, 2 …
inline std::vector<std::int16_t> numbers(std::size_t count) {
  std::vector<std::int16_t> values(count);
  for (std::size_t n = 0; n < count; ++n) values[n] = static_cast<std::int16_t>(n);
  return values;
}

/// A grid whose voxels all differ: detects a swapped or mirrored axis.
template <class T>
volume::Grid<T> numbered_grid(const volume::GridGeometry& geometry) {
  volume::Grid<T> grid(geometry);
  for (std::size_t n = 0; n < grid.voxels.size(); ++n) grid.voxels[n] = static_cast<T>(n);
  return grid;
}

inline void expect_same_place(const volume::GridGeometry& a, const volume::GridGeometry& b, double tolerance_mm) {
  ASSERT_EQ(a.size, b.size);
  const Vec3 last(static_cast<double>(a.size[0] - 1), static_cast<double>(a.size[1] - 1),
                  static_cast<double>(a.size[2] - 1));
  for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(last[0], 0, 0), Vec3(0, last[1], 0), Vec3(0, 0, last[2]), last})
    EXPECT_LT((a.to_mm(corner) - b.to_mm(corner)).norm(), tolerance_mm);
}

}  // namespace trocar::testing
