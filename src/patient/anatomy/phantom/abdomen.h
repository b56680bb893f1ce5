#pragma once

#include "anatomy/phantom/biopsy.h"

namespace trocar::anatomy::phantom {

/// Fills an empty anatomy with an upper abdomen, and returns the biopsy planned in it. Errors: see plan_biopsy; an
/// unknown structure name.
Result<BiopsyPlan> build_abdomen(Anatomy& anatomy);

}  // namespace trocar::anatomy::phantom
