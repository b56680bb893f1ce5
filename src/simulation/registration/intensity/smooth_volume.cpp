#include "registration/intensity/smooth_volume.h"

#include <limits>

#include "core/parallel.h"
#include "volume/gaussian_blur.h"

namespace trocar::registration {

volume::FloatGrid smooth_usable(const volume::FloatGrid& values, const volume::MaskGrid& usable, double sigma_mm) {
  volume::FloatGrid sum(values.geometry), weight(values.geometry);
  for (std::size_t n = 0; n < values.voxels.size(); ++n) {
    if (usable.voxels[n] == 0) continue;
    sum.voxels[n] = values.voxels[n];
    weight.voxels[n] = 1.0F;
  }
  const Vec3 sigma_voxels = sigma_mm * values.geometry.spacing_mm.cwiseInverse();
  volume::gaussian_blur(sum, sigma_voxels);
  volume::gaussian_blur(weight, sigma_voxels);
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  parallel_for(sum.voxels.size(), 1 << 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      sum.voxels[n] = usable.voxels[n] != 0 && weight.voxels[n] > 0.0F ? sum.voxels[n] / weight.voxels[n] : kNothing;
  });
  return sum;
}

}  // namespace trocar::registration
