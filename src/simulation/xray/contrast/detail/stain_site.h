#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "geometry/vec.h"
#include "volume/grid.h"
#include "xray/contrast/contrast_table.h"

namespace trocar::xray::detail {

/// Steps to the voxels that share a face.
inline constexpr std::array<volume::Index3, 6> kNeighbours{
    {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};

/// The way of contrast agent through tissue from a tip, on an isotropic lattice: each voxel's reach, the distance from
/// the tip weighted with the resistance on the way (fast marching, |grad reach| = resistance), and its uptake. Both
/// are heterogeneous (uptake_field); beside vessels and ducts, along the tracts, the resistance is lower.
/// docs/physics.md, X14.
class StainSite {
 public:
  struct Voxel {
    volume::Index3 at{};
    double reach_mm = 0.0;
    double uptake = 1.0;
  };
  /// A neighbour of the site's voxels: whether agent can enter it.
  using CanEnter = std::function<bool(const volume::Index3&)>;
  /// Whether a voxel borders on a vessel or duct.
  using IsTract = std::function<bool(const volume::Index3&)>;

  StainSite() = default;
  /// The seed is a voxel of the lattice at or near the tip.
  StainSite(const volume::GridGeometry& lattice, const Vec3& tip_P, const volume::Index3& seed,
            const ContrastMedium& medium);

  /// Voxels by reach, ascending.
  const std::vector<Voxel>& voxels() const { return voxels_; }
  /// Appends the voxel of the next larger reach; false if there is none.
  bool expand(const CanEnter& can_enter, const IsTract& is_tract);
  /// Share of its room that a voxel takes up when the front is at `front_mm`: 1 at the tip, 0 from the front on, as
  /// the pressure around a point source falls.
  static double share(const Voxel& voxel, double front_mm) noexcept;

 private:
  struct Waiting {
    double reach_mm;
    volume::Index3 at;
    bool operator>(const Waiting& other) const { return reach_mm > other.reach_mm; }
  };

  double resistance(const volume::Index3& at, bool is_tract) const;
  double find_reach(const volume::Index3& at, double resistance) const;

  volume::GridGeometry lattice_;
  Vec3 tip_P_ = Vec3::Zero();
  double heterogeneity_ = 0.0, correlation_mm_ = 1.0;
  std::vector<Voxel> voxels_;
  std::vector<Waiting> frontier_;                       ///< Heap, with outdated entries.
  std::unordered_map<std::size_t, double> reach_mm_;    ///< Of the appended voxels, by offset in the lattice.
  std::unordered_map<std::size_t, double> resistance_;  ///< Of the voxels that were looked at.
};

/// Heterogeneity of tissue: a seeded random number at each point of P with mean 0 and variance 1, a sum of quadratic
/// B-splines on a lattice of `correlation_mm` (> 0) with independent uniform coefficients. Averaged over the places of
/// the lattice, its correlation along an axis is the quintic B-spline: 0.39 at correlation_mm, 0.015 at twice, 0 at
/// three times that distance. Real-time safe.
double uptake_field(const Vec3& p_P, double correlation_mm, std::uint64_t seed) noexcept;

}  // namespace trocar::xray::detail
