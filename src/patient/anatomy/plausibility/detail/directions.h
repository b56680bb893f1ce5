#pragma once

#include <array>
#include <string>
#include <vector>

#include "anatomy/label_table.h"
#include "anatomy/plausibility/detail/label_shapes.h"

namespace trocar::anatomy::detail {

/// How often structures lie on the side of each other that their names say, along one axis of P.
struct AxisVotes {
  int right = 0, wrong = 0;
  std::vector<std::string> wrong_ones;  ///< "liver on the left".
  std::vector<std::string> misplaced;   ///< Those of them that lie on one side in nearly everybody.
  bool is_reversed() const noexcept { return wrong >= 2 && wrong > 2 * right; }
};

/// Votes along x (left), y (back) and z (head). `middle_x_P`: of the body, for a segmentation without a spine.
std::array<AxisVotes, 3> vote_directions(const LabelShapes& shapes, double voxel_ml, const LabelTable& table,
                                         double middle_x_P);

}  // namespace trocar::anatomy::detail
