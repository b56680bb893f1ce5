#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "xray/projection/xray_volume.h"

namespace trocar::xray::detail {

/// The terms of a beam's signal: weight * exp(-sum of masses * coefficients), one term an energy. The weights' sum
/// is 1.
struct BeamTerms {
  std::vector<float> weight;
  std::array<std::vector<float>, kBases> cm2_per_g;
};

/// Signal of `count` pixels from their masses (g/cm²) by basis; nullptr: none of it. SIMD. No allocation.
void sum_terms(const BeamTerms& terms, const std::array<const float*, kBases>& g_per_cm2, std::size_t count,
               float* signal) noexcept;

}  // namespace trocar::xray::detail
