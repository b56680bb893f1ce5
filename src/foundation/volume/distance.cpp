#include "volume/distance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "core/parallel.h"

namespace trocar::volume::detail {

/// Lower envelope of the parabolas (x - position)^2 + value, added in order of rising position (Felzenszwalb &
/// Huttenlocher 2012, doi 10.4086/toc.2012.v008a019); here at arbitrary positions, evaluated at multiples of a spacing,
/// and without the divisions that compute the intersections.
class LowerEnvelope {
 public:
  explicit LowerEnvelope(std::size_t capacity) : parabolas_(capacity) {}

  void clear() noexcept { count_ = 0; }

  /// Adds a parabola; one of infinite value is ignored. At most `capacity` may be added; positions rise strictly.
  void add(double position, double value) noexcept {
    if (value == std::numeric_limits<double>::infinity()) return;
    const Parabola added{position, value};
    while (count_ >= 2 && is_hidden(parabolas_[count_ - 2], parabolas_[count_ - 1], added)) --count_;
    parabolas_[count_++] = added;
  }

  /// out[n] = the envelope at n * spacing; infinity if no parabola was added.
  void evaluate(double spacing, std::span<float> out) const noexcept {
    if (count_ == 0) {
      std::fill(out.begin(), out.end(), std::numeric_limits<float>::infinity());
      return;
    }
    std::size_t current = 0;
    for (std::size_t n = 0; n < out.size(); ++n) {
      const double x = static_cast<double>(n) * spacing;
      double lowest = parabolas_[current].at(x);
      for (; current + 1 < count_; ++current) {
        const double next = parabolas_[current + 1].at(x);
        if (next > lowest) break;
        lowest = next;
      }
      out[n] = static_cast<float>(lowest);
    }
  }

 private:
  struct Parabola {
    double position;
    double value;
    double at(double x) const noexcept { return (x - position) * (x - position) + value; }
  };

  /// True if b is nowhere below both a and c: c intersects a before b does.
  static bool is_hidden(const Parabola& a, const Parabola& b, const Parabola& c) noexcept {
    const double ab = b.position - a.position;
    const double bc = c.position - b.position;
    const double ac = ab + bc;
    return ac * b.value - bc * a.value - ab * c.value >= ab * bc * ac;
  }

  std::vector<Parabola> parabolas_;
  std::size_t count_ = 0;
};

}  // namespace trocar::volume::detail

// Squared distances are computed along i by two scans of the row, then along j and along k by the lower envelope of the
// parabolas of a line. The points of zero distance ("sites") are at voxel centres for the distance to a mask, and at
// the centres of the faces between different voxels for the signed distance. Faces across i are on the rows of voxels,
// faces across j on rows half way between them, faces across k on planes half way between the planes.

namespace trocar::volume {
namespace {

constexpr float kNoSite = std::numeric_limits<float>::infinity();
constexpr std::size_t kTile = 16;  ///< Lines processed together: one cache line of floats per row.

struct Extent {
  std::size_t i, j, k;
  explicit Extent(const GridGeometry& g)
      : i(static_cast<std::size_t>(g.size[0])),
        j(static_cast<std::size_t>(g.size[1])),
        k(static_cast<std::size_t>(g.size[2])) {}
  std::size_t plane() const { return i * j; }
};

/// Squares the smaller of a forward and a backward count of voxels.
void finish_row(std::span<const float> forward, double spacing_mm, float at_end, auto is_site, float site_value,
                std::span<float> out) {
  float steps = at_end;
  for (std::size_t i = out.size(); i-- > 0;) {
    steps = is_site(i) ? site_value : steps + 1.0F;
    const double nearest_mm = static_cast<double>(std::min(steps, forward[i])) * spacing_mm;
    out[i] = static_cast<float>(nearest_mm * nearest_mm);
  }
}

/// Squared distance along the row to its nearest site; sites are voxel centres.
void spread_centres(auto is_site, double spacing_mm, std::span<float> forward, std::span<float> out) {
  float steps = kNoSite;
  for (std::size_t i = 0; i < out.size(); ++i) {
    steps = is_site(i) ? 0.0F : steps + 1.0F;
    forward[i] = steps;
  }
  finish_row(forward, spacing_mm, kNoSite, is_site, 0.0F, out);
}

/// Squared distance along the row to the nearest face between different voxels.
void spread_faces(std::span<const std::uint8_t> row, double spacing_mm, std::span<float> forward,
                  std::span<float> out) {
  float steps = kNoSite;
  for (std::size_t i = 0; i < row.size(); ++i) {
    steps = i > 0 && row[i] != row[i - 1] ? 0.5F : steps + 1.0F;
    forward[i] = steps;
  }
  const auto face_above = [&](std::size_t i) { return i + 1 < row.size() && row[i] != row[i + 1]; };
  finish_row(forward, spacing_mm, kNoSite, face_above, 0.5F, out);
}

/// The same to the voxels that differ between two neighbouring rows.
void spread_differences(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, double spacing_mm,
                        std::span<float> forward, std::span<float> out) {
  if (std::equal(a.begin(), a.end(), b.begin())) {
    std::fill(out.begin(), out.end(), kNoSite);
    return;
  }
  spread_centres([&](std::size_t i) { return a[i] != b[i]; }, spacing_mm, forward, out);
}

/// Lines across a plane or a volume: `count` values at a distance of `stride`, with adjacent lines next to each other.
/// Values on the voxels are replaced by their lower envelope with those half way between the voxels (`between`, one
/// less; may be null).
struct Lines {
  float* values;
  const float* between;
  std::size_t count;
  std::size_t stride;
  double spacing_mm;
};

/// Copies a tile of lines so that each becomes contiguous.
void load_tile(const float* from, std::size_t count, std::size_t stride, std::size_t width, std::vector<float>& tile) {
  for (std::size_t n = 0; n < count; ++n)
    for (std::size_t c = 0; c < width; ++c) tile[c * count + n] = from[n * stride + c];
}

void spread_lines(const Lines& lines, std::size_t width) {
  std::vector<float> on(kTile * lines.count);
  std::vector<float> between(lines.between != nullptr ? kTile * (lines.count - 1) : 0);
  detail::LowerEnvelope envelope(2 * lines.count);
  for (std::size_t start = 0; start < width; start += kTile) {
    const std::size_t tile = std::min(kTile, width - start);
    load_tile(lines.values + start, lines.count, lines.stride, tile, on);
    if (lines.between != nullptr) load_tile(lines.between + start, lines.count - 1, lines.stride, tile, between);
    for (std::size_t c = 0; c < tile; ++c) {
      float* line = on.data() + c * lines.count;
      const float* half = lines.between != nullptr ? between.data() + c * (lines.count - 1) : nullptr;
      envelope.clear();
      for (std::size_t n = 0; n < lines.count; ++n) {
        envelope.add(static_cast<double>(n) * lines.spacing_mm, static_cast<double>(line[n]));
        if (half != nullptr && n + 1 < lines.count)
          envelope.add((static_cast<double>(n) + 0.5) * lines.spacing_mm, static_cast<double>(half[n]));
      }
      envelope.evaluate(lines.spacing_mm, {line, lines.count});
    }
    for (std::size_t n = 0; n < lines.count; ++n)
      for (std::size_t c = 0; c < tile; ++c) lines.values[start + n * lines.stride + c] = on[c * lines.count + n];
  }
}

/// Computes along k and takes the root; `between` contains the planes half way, or is empty.
void spread_across_planes(const GridGeometry& geometry, const std::vector<float>& between, std::vector<float>& values) {
  const Extent n(geometry);
  parallel_for(n.j, 4, [&](std::size_t first, std::size_t last) {
    for (std::size_t j = first; j < last; ++j) {
      float* row = values.data() + j * n.i;
      const float* half = between.empty() ? nullptr : between.data() + j * n.i;
      spread_lines({row, half, n.k, n.plane(), geometry.spacing_mm.z()}, n.i);
      for (std::size_t k = 0; k < n.k; ++k)
        for (std::size_t i = 0; i < n.i; ++i) row[k * n.plane() + i] = std::sqrt(row[k * n.plane() + i]);
    }
  });
}

std::span<const std::uint8_t> mask_row(const MaskGrid& mask, std::size_t row) {
  const auto n = static_cast<std::size_t>(mask.geometry.size[0]);
  return {mask.voxels.data() + row * n, n};
}

/// Squared distance in plane k to the faces across i and j of that plane.
void faces_in_plane(const MaskGrid& mask, std::size_t k, std::span<float> out) {
  const Extent n(mask.geometry);
  const Vec3& spacing = mask.geometry.spacing_mm;
  std::vector<float> forward(n.i);
  std::vector<float> between((n.j - 1) * n.i);
  for (std::size_t j = 0; j < n.j; ++j) {
    const auto row = mask_row(mask, k * n.j + j);
    spread_faces(row, spacing.x(), forward, out.subspan(j * n.i, n.i));
    if (j + 1 < n.j)
      spread_differences(row, mask_row(mask, k * n.j + j + 1), spacing.x(), forward, {between.data() + j * n.i, n.i});
  }
  spread_lines({out.data(), between.empty() ? nullptr : between.data(), n.j, n.i, spacing.y()}, n.i);
}

/// Squared distance in the plane half way between k and k + 1 to the faces between these two.
void faces_between_planes(const MaskGrid& mask, std::size_t k, std::span<float> out) {
  const Extent n(mask.geometry);
  const Vec3& spacing = mask.geometry.spacing_mm;
  std::vector<float> forward(n.i);
  for (std::size_t j = 0; j < n.j; ++j)
    spread_differences(mask_row(mask, k * n.j + j), mask_row(mask, (k + 1) * n.j + j), spacing.x(), forward,
                       out.subspan(j * n.i, n.i));
  spread_lines({out.data(), nullptr, n.j, n.i, spacing.y()}, n.i);
}

/// Squared distance in plane k to the voxel centres of the mask in that plane.
void centres_in_plane(const MaskGrid& mask, std::size_t k, std::span<float> out) {
  const Extent n(mask.geometry);
  std::vector<float> forward(n.i);
  for (std::size_t j = 0; j < n.j; ++j) {
    const auto row = mask_row(mask, k * n.j + j);
    spread_centres([&](std::size_t i) { return row[i] != 0; }, mask.geometry.spacing_mm.x(), forward,
                   out.subspan(j * n.i, n.i));
  }
  spread_lines({out.data(), nullptr, n.j, n.i, mask.geometry.spacing_mm.y()}, n.i);
}

}  // namespace

FloatGrid signed_distance_mm(const MaskGrid& mask) {
  FloatGrid result(mask.geometry);
  if (mask.empty()) return result;
  const Extent n(mask.geometry);
  std::vector<float> between((n.k - 1) * n.plane());
  parallel_for(n.k, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      faces_in_plane(mask, k, {result.voxels.data() + k * n.plane(), n.plane()});
      if (k + 1 < n.k) faces_between_planes(mask, k, {between.data() + k * n.plane(), n.plane()});
    }
  });
  spread_across_planes(mask.geometry, between, result.voxels);
  parallel_for(result.voxels.size(), std::size_t{1} << 20, [&](std::size_t first, std::size_t last) {
    for (std::size_t n_voxel = first; n_voxel < last; ++n_voxel)
      if (mask.voxels[n_voxel] != 0) result.voxels[n_voxel] = -result.voxels[n_voxel];
  });
  return result;
}

FloatGrid distance_to_mask_mm(const MaskGrid& mask) {
  FloatGrid result(mask.geometry);
  if (mask.empty()) return result;
  const Extent n(mask.geometry);
  parallel_for(n.k, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k)
      centres_in_plane(mask, k, {result.voxels.data() + k * n.plane(), n.plane()});
  });
  spread_across_planes(mask.geometry, {}, result.voxels);
  return result;
}

}  // namespace trocar::volume
