#pragma once

#include <memory>

#include "anatomy/patient.h"
#include "xray/projection/mass_image.h"

namespace trocar::xray {

/// A patient as a volume of basis materials: density of water and of bone (g/cm³) in each voxel, from HU and, where the
/// label says what it is, from the tissue's composition (data/xray_materials.toml). Immutable, for all threads.
class XrayVolume {
 public:
  /// Error: the patient has no CT, or a material is missing.
  static Result<std::shared_ptr<const XrayVolume>> make(std::shared_ptr<const anatomy::VirtualPatient> patient);
  /// From a CT alone: bone above 150 HU, a mixture between. For tests and benchmarks.
  static Result<std::shared_ptr<const XrayVolume>> from_ct(const volume::CtGrid& ct);

  const volume::GridGeometry& geometry() const noexcept;
  struct Impl;
  const Impl& impl() const noexcept { return *impl_; }

 private:
  std::shared_ptr<const Impl> impl_;
};

}  // namespace trocar::xray
