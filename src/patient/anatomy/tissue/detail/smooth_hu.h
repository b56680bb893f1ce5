#pragma once

#include "volume/grid.h"

namespace trocar::anatomy::detail {

/// The CT with its noise reduced by binomial filters (1 2 1)/4 along the axes that are sampled finely enough: two
/// passes below 1.2 mm, one below 2.5 mm, none above. Standard deviation of the kernel about 0.7..1.2 mm.
volume::CtGrid smooth_hu(const volume::CtGrid& ct);

}  // namespace trocar::anatomy::detail
