#pragma once

#include <cmath>
#include <memory>

#include "xray/projection/xray_volume.h"

namespace trocar::xray::testing {

/// A trunk of water, 280 mm wide and 200 mm deep, with a rod of bone (radius 12 mm) along the body axis, 40 mm behind
/// the middle; the isocentre is its middle. Voxels of 4 mm.
inline std::shared_ptr<const XrayVolume> trunk() {
  static const auto made = [] {
    volume::GridGeometry geometry;
    geometry.size = {80, 60, 60};
    geometry.spacing_mm = Vec3::Constant(4.0);
    geometry.origin_P = -0.5 * 4.0 * Vec3(79, 59, 59);
    volume::CtGrid ct(geometry, -1000);
    for (std::size_t n = 0; n < ct.voxels.size(); ++n) {
      const Vec3 p_P = geometry.centre_mm(geometry.index_of(n));
      if (std::hypot(p_P.x() / 140.0, p_P.y() / 100.0) < 1.0) ct.voxels[n] = 0;
      if (std::hypot(p_P.x(), p_P.y() - 40.0) < 12.0) ct.voxels[n] = 1000;
    }
    return XrayVolume::from_ct(ct).value();
  }();
  return made;
}

}  // namespace trocar::xray::testing
