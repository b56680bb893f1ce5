#pragma once

#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"
#include "phantom/liver.h"
#include "phantom/structure.h"

namespace trocar::phantom {

/// Distances that the expert path of the biopsy keeps (mm).
struct PathMargins {
  double bone_mm = 3.0;     ///< Ribs, cartilage, vertebrae.
  double organ_mm = 5.0;    ///< Vessels, lung, bowel, stomach, gallbladder, kidney.
  double liver_mm = 10.0;   ///< Liver before the lesion.
  double reserve_mm = 1.2;  ///< Added to all margins: a voxel of the default grid.
};

struct Lesion {
  Vec3f centre;  ///< P.
  float radius_mm;
};

/// Three lesions, and the path to the first.
struct BiopsyPlan {
  PathMargins margins;
  std::vector<Lesion> lesions;
  anatomy::NeedlePath path;

  /// True if a liver vessel of this radius at p would touch a lesion or the surroundings of the path.
  bool is_in_the_way(const Vec3f& p, float vessel_radius_mm) const;
};

/// Selects positions for three lesions; a needle can reach the first one between two ribs of the right flank. Called
/// before the liver's vessels grow, which avoid lesions and path. Margins are measured to the anatomy's surfaces.
/// Error: no position in 60,000 tries.
Result<BiopsyPlan> plan_biopsy(const Anatomy& anatomy, const PathMargins& margins = {});

void add_lesions(Anatomy& anatomy, const BiopsyPlan& plan);

/// Portal and hepatic veins inside the liver, grown by rule around lesions and path, with bile ducts and arteries
/// beside the portal veins. Returns the ducts.
DuctTree add_liver_vessels(Anatomy& anatomy, const BiopsyPlan& plan);

/// Fills an empty anatomy with an upper abdomen, and returns the biopsy planned in it. Errors: see plan_biopsy; an
/// unknown structure name.
Result<BiopsyPlan> build_abdomen(Anatomy& anatomy);

}  // namespace trocar::phantom
