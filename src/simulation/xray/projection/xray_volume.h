#pragma once

#include <memory>

#include "anatomy/patient.h"
#include "xray/geometry/c_arm.h"
#include "xray/projection/mass_image.h"

namespace trocar::xray {

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

}  // namespace trocar::xray
