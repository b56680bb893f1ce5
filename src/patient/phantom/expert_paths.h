#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"
#include "phantom/liver.h"
#include "phantom/structure.h"

namespace trocar::phantom {

/// Expert paths of the punctures whose target exists in every body, in P of the patient (mm). Distances to bone,
/// vessels, bowel and lung are measured to the anatomy's surfaces. Error of each: this body has no safe path.

/// In the midline between two spinous processes below L2, into the middle of the dural sac: one path for each
/// interspace through which a needle fits, the widest first.
Result<std::vector<anatomy::NeedlePath>> plan_lumbar_paths(const Anatomy& anatomy);
/// Into free fluid of the left and the right lower quadrant, lateral to the epigastric vessels, away from bowel.
Result<std::vector<anatomy::NeedlePath>> plan_ascites_paths(const Anatomy& anatomy);
/// Between two ribs of the right flank, below the lung, into a peripheral bile duct.
Result<std::vector<anatomy::NeedlePath>> plan_bile_duct_paths(const Anatomy& anatomy, const DuctTree& ducts);

/// Skin over the anterior superior iliac spine; sign -1 right, 1 left. Reference body.
Vec3f iliac_spine_on_skin(const Anatomy& anatomy, float sign);

/// Structures of one kind that a path keeps away from.
class Obstacles {
 public:
  /// Structures whose name begins with one of these.
  Obstacles(const Anatomy& anatomy, std::span<const std::string_view> prefixes);
  /// True if all are farther than this from a place, mm.
  bool all_farther(const Place& place, float mm) const;

 private:
  std::vector<const Structure*> structures_;
};

/// Bones and cartilages.
Obstacles bones_of(const Anatomy& anatomy);

/// Where a ray from inside leaves the body.
Vec3f leave_body(const Anatomy& anatomy, const Vec3f& inside, const Vec3f& direction);

}  // namespace trocar::phantom
