#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "anatomy/phantom/structure.h"

namespace trocar::anatomy::phantom {

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

}  // namespace trocar::anatomy::phantom
