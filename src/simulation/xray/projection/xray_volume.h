#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "anatomy/patient.h"
#include "volume/grid.h"
#include "xray/geometry/c_arm.h"

namespace trocar::xray {

/// Basis materials: the matter on a ray is a mass per area of each. Body tissues are mixtures of the first two, which
/// have the same attenuation at all energies of a tube (no body tissue has an edge there).
enum class Basis : std::uint8_t { kWater, kBone, kIodine, kSteel };
inline constexpr std::size_t kBases = 4;

/// Mass per area (g/cm²) of the basis materials along the ray of each pixel, row by row. An empty image is zero
/// everywhere.
struct MassImage {
  int columns = 0, rows = 0;
  std::array<std::vector<float>, kBases> g_per_cm2;

  std::vector<float>& of(Basis basis) noexcept { return g_per_cm2[static_cast<std::size_t>(basis)]; }
  const std::vector<float>& of(Basis basis) const noexcept { return g_per_cm2[static_cast<std::size_t>(basis)]; }
  std::size_t size() const noexcept { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

/// A patient as a volume of basis materials: density of water and of bone (g/cm³) in each voxel, from HU and, where the
/// voxel has a label, from the tissue's composition (data/xray_materials.toml). Only the body: a table in the CT is
/// left out. Immutable, for all threads. Eight bytes a voxel of the body.
class XrayVolume {
 public:
  /// Error: the patient has no CT, or a material is missing.
  static Result<std::shared_ptr<const XrayVolume>> make(std::shared_ptr<const anatomy::VirtualPatient> patient);
  /// From a CT alone: water up to 0 HU, a mixture by volume of water and cortical bone above. For tests and benchmarks.
  static Result<std::shared_ptr<const XrayVolume>> from_ct(const volume::CtGrid& ct);

  const volume::GridGeometry& geometry() const noexcept;
  /// Whether a point of P is inside the body: behind the skin, or, for a CT alone, in a voxel that is not air.
  bool is_inside_body(const Vec3& p_P) const noexcept;

  struct Impl;
  explicit XrayVolume(std::shared_ptr<const Impl> impl) noexcept;
  const Impl& impl() const noexcept { return *impl_; }

 private:
  std::shared_ptr<const Impl> impl_;
};

/// One clear line if the source or the detector of a C-arm would be inside the patient's body. Exit status 2.
Status check_source(const XrayVolume& volume, const CArm& arm);

/// Masses of water and bone along each ray (a digitally reconstructed radiograph before the physics of the beam). All
/// cores. The volume is in the patient now (moved_volume.h). docs/physics.md, X6.
void project(const XrayVolume& volume, const XrayRays& rays, MassImage& masses);

/// Integrals of a grid along each ray, in units of the grid times cm: for agents in a small part of the body.
void project(const volume::FloatGrid& grid, const XrayRays& rays, std::vector<float>& integrals);

}  // namespace trocar::xray
