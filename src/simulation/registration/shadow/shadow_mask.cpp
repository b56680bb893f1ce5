#include "registration/shadow/shadow_mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "core/result.h"
#include "volume/sampling.h"

namespace trocar::registration {
namespace {

constexpr double kLevels = 256.0;
constexpr double kStep_voxels = 0.5;  ///< Between samples of a beam.

double finest_mm(const volume::GridGeometry& geometry) {
  return geometry.spacing_mm.minCoeff();
}

template <class Body>
void for_each_voxel(const volume::GridGeometry& geometry, Body body) {
  const auto row = static_cast<std::size_t>(geometry.size[0]);
  parallel_for(geometry.voxel_count() / row, 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first * row; n < last * row; ++n) body(n, geometry.centre_mm(geometry.index_of(n)));
  });
}

/// For each beam of a raster of directions, the depth of its deepest echo.
struct DeepestEchoes {
  double first_lateral = 0.0, first_elevation = 0.0;
  double lateral_step = 1.0, elevation_step = 1.0;
  std::int64_t columns = 1, rows = 1;
  std::vector<float> depth_mm;  ///< Negative: no echo.

  Beams::Place place(std::int64_t column, std::int64_t row, double depth) const {
    return {first_lateral + lateral_step * static_cast<double>(column),
            first_elevation + elevation_step * static_cast<double>(row), depth};
  }
  double at(const Beams::Place& p) const {
    const auto nearest = [](double v, std::int64_t count) {
      return std::clamp<std::int64_t>(std::llround(v), 0, count - 1);
    };
    const std::int64_t column = nearest((p.lateral - first_lateral) / lateral_step, columns);
    const std::int64_t row = nearest((p.elevation - first_elevation) / elevation_step, rows);
    return static_cast<double>(depth_mm[static_cast<std::size_t>(row * columns + column)]);
  }
};

/// Directions so dense that neighbouring beams are a voxel apart at the deepest sample.
DeepestEchoes lay_beams(const Beams& beams, const volume::GridGeometry& geometry) {
  DeepestEchoes echoes;
  constexpr double kSmall_rad = 1e-3;
  const Vec3 deepest = beams.to_point({0.0, 0.0, beams.depth_mm()});
  const double lateral_mm = (beams.to_point({kSmall_rad, 0.0, beams.depth_mm()}) - deepest).norm() / kSmall_rad;
  const double elevation_mm = (beams.to_point({0.0, kSmall_rad, beams.depth_mm()}) - deepest).norm() / kSmall_rad;
  const auto count = [&](double half_rad, double mm_per_rad) {
    return std::max<std::int64_t>(
        2, static_cast<std::int64_t>(std::ceil(2.0 * half_rad * mm_per_rad / finest_mm(geometry))) + 1);
  };
  echoes.columns = count(beams.half_view_rad(), lateral_mm);
  echoes.rows = count(beams.half_sweep_rad(), elevation_mm);
  echoes.first_lateral = -beams.half_view_rad();
  echoes.first_elevation = -beams.half_sweep_rad();
  echoes.lateral_step = 2.0 * beams.half_view_rad() / static_cast<double>(echoes.columns - 1);
  echoes.elevation_step = 2.0 * beams.half_sweep_rad() / static_cast<double>(echoes.rows - 1);
  echoes.depth_mm.resize(static_cast<std::size_t>(echoes.columns * echoes.rows));
  return echoes;
}

DeepestEchoes find_deepest_echoes(const volume::LabelGrid& gray, const Beams& beams, double threshold) {
  DeepestEchoes echoes = lay_beams(beams, gray.geometry);
  const double step_mm = kStep_voxels * finest_mm(gray.geometry);
  parallel_for(echoes.depth_mm.size(), 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      const auto beam = static_cast<std::int64_t>(n);
      double depth_mm = beams.depth_mm();
      while (depth_mm >= 0.0) {
        const Beams::Place at = echoes.place(beam % echoes.columns, beam / echoes.columns, depth_mm);
        if (sample_nearest(gray, beams.to_point(at), std::uint8_t{0}) >= threshold) break;
        depth_mm -= step_mm;
      }
      echoes.depth_mm[n] = static_cast<float>(depth_mm);
    }
  });
  return echoes;
}

volume::MaskGrid shadows_of_fan(const volume::LabelGrid& gray, const Beams& beams, double threshold) {
  const DeepestEchoes echoes = find_deepest_echoes(gray, beams, threshold);
  volume::MaskGrid shadow(gray.geometry);
  const double half_voxel_mm = 0.5 * finest_mm(gray.geometry);
  for_each_voxel(gray.geometry, [&](std::size_t n, const Vec3& p) {
    const Beams::Place at = beams.to_place(p);
    shadow.voxels[n] = at.depth_mm > echoes.at(at) + half_voxel_mm ? 1 : 0;
  });
  return shadow;
}

/// A line of voxels along the beam, from the first sample at the transducer.
struct BeamLine {
  std::size_t begin = 0;
  std::ptrdiff_t step = 1;
  std::int64_t count = 0;
  std::size_t at(std::int64_t n) const {
    return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(begin) + n * step);
  }
};

/// Calls body(line) for every line of voxels along parallel beams.
template <class Body>
void for_each_line(const volume::GridGeometry& geometry, const Beams& beams, Body body) {
  const Vec3 direction_V = geometry.R_PV.transpose() * beams.direction(geometry.origin_P);
  int axis = 0;
  direction_V.cwiseAbs().maxCoeff(&axis);
  const auto& size = geometry.size;
  const std::array<std::ptrdiff_t, 3> strides = {1, size[0], size[0] * size[1]};
  const int first_other = axis == 0 ? 1 : 0;
  const int second_other = axis == 2 ? 1 : 2;
  const auto a = static_cast<std::size_t>(axis);
  const auto u = static_cast<std::size_t>(first_other);
  const auto v = static_cast<std::size_t>(second_other);
  const bool is_forward = direction_V[axis] > 0.0;
  const auto lines = static_cast<std::size_t>(size[u] * size[v]);
  parallel_for(lines, 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      const auto line = static_cast<std::int64_t>(n);
      const std::ptrdiff_t corner = (line % size[u]) * strides[u] + (line / size[u]) * strides[v];
      const std::ptrdiff_t begin = is_forward ? corner : corner + (size[a] - 1) * strides[a];
      body(BeamLine{static_cast<std::size_t>(begin), is_forward ? strides[a] : -strides[a], size[a]});
    }
  });
}

volume::MaskGrid shadows_of_lines(const volume::LabelGrid& gray, const Beams& beams, double threshold) {
  volume::MaskGrid shadow(gray.geometry);
  for_each_line(gray.geometry, beams, [&](const BeamLine& line) {
    for (std::int64_t n = line.count - 1; n >= 0 && gray.voxels[line.at(n)] < threshold; --n)
      shadow.voxels[line.at(n)] = 1;
  });
  return shadow;
}

}  // namespace

Result<double> estimate_shadow_threshold(std::span<const volume::LabelGrid> scans,
                                         std::span<const volume::MaskGrid> inside) {
  TROCAR_CHECK(scans.size() == inside.size());
  std::array<double, 257> count{}, sum{};  // of the levels below
  for (std::size_t s = 0; s < scans.size(); ++s) {
    for (std::size_t n = 0; n < scans[s].voxels.size(); ++n)
      if (inside[s].voxels[n] != 0) count[scans[s].voxels[n] + 1U] += 1.0;
  }
  for (std::size_t g = 1; g < count.size(); ++g) {
    sum[g] = sum[g - 1] + static_cast<double>(g - 1) * count[g];
    count[g] += count[g - 1];
  }
  // The variance between classes is the sum of (sum of a class)^2 / (its count), less a constant.
  const auto part = [&](std::size_t low, std::size_t high) {
    const double n = count[high] - count[low], total = sum[high] - sum[low];
    return n > 0.0 ? total * total / n : 0.0;
  };
  double best = part(0, 256) * (1.0 + 1e-9);
  std::size_t threshold = 0;
  for (std::size_t low = 1; low < 255; ++low) {
    for (std::size_t high = low + 1; high < 256; ++high) {
      const double between = part(0, low) + part(low, high) + part(high, 256);
      if (between <= best) continue;
      best = between;
      threshold = low;
    }
  }
  if (threshold == 0) return fail("all voxels have the same gray level", {}, "give a volume with an image");
  return static_cast<double>(threshold);
}

volume::MaskGrid imaged_voxels(const volume::LabelGrid& gray, const Beams& beams) {
  volume::MaskGrid inside(gray.geometry, 1);
  if (beams.is_fan()) {
    for_each_voxel(gray.geometry, [&](std::size_t n, const Vec3& p) {
      inside.voxels[n] = beams.is_inside(beams.to_place(p)) ? 1 : 0;
    });
    return inside;
  }
  for_each_line(gray.geometry, beams, [&](const BeamLine& line) {
    for (std::int64_t n = 0; n < line.count && gray.voxels[line.at(n)] == 0; ++n) inside.voxels[line.at(n)] = 0;
  });
  return inside;
}

Result<ImagedRegion> find_shadows(const volume::LabelGrid& gray, const Beams& beams, double threshold) {
  if (!(threshold >= 0.0 && threshold < kLevels))
    return fail_usage("the shadow threshold is not a gray level", fmt::format("{:g}", threshold), "give 0 to 255");
  ImagedRegion region;
  region.inside = imaged_voxels(gray, beams);
  region.usable = beams.is_fan() ? shadows_of_fan(gray, beams, threshold) : shadows_of_lines(gray, beams, threshold);
  std::size_t inside = 0, shadowed = 0;
  for (std::size_t n = 0; n < region.usable.voxels.size(); ++n) {
    const bool is_inside = region.inside.voxels[n] != 0;
    const bool is_shadow = region.usable.voxels[n] != 0;
    inside += is_inside ? 1 : 0;
    shadowed += is_inside && is_shadow ? 1 : 0;
    region.usable.voxels[n] = is_inside && !is_shadow ? 1 : 0;
  }
  region.shadow_share = inside == 0 ? 0.0 : static_cast<double>(shadowed) / static_cast<double>(inside);
  return region;
}

}  // namespace trocar::registration
