#pragma once

#include <span>

namespace trocar::volume::detail {

/// out[n] = sum over t of weights[t] * sources[t][n]. `sources` and `weights` have the same length (checked); each
/// source has at least out.size() values and may not overlap `out`. SIMD, selected at run time.
void add_weighted_rows(std::span<const float* const> sources, std::span<const float> weights, std::span<float> out);

}  // namespace trocar::volume::detail
