#pragma once

#include "anatomy/derive/derive_choice.h"
#include "anatomy/derive/detail/posterior_wall.h"

namespace trocar::anatomy::detail {

/// Adds what is chosen of dural_sac, ligamentum_flavum and epidural_fat, and shortens a labelled spinal cord that
/// contains the sac. Published sizes: spine_parts.cpp.
void derive_canal_contents(DerivedLabels& labels, const SpineLabels& spine, const Canal& canal,
                           const PosteriorWall& wall, const DeriveChoice& choice);

/// Adds what is chosen of interspinous_ligament and supraspinous_ligament.
void derive_spinous_ligaments(DerivedLabels& labels, const SpineLabels& spine, const Canal& canal,
                              const PosteriorWall& wall, const DeriveChoice& choice);

}  // namespace trocar::anatomy::detail
