#pragma once

#include <array>
#include <string>
#include <vector>

#include "anatomy/label_table.h"
#include "volume/grid.h"

namespace trocar::anatomy::detail {

/// How often structures lie on the side of each other that their names say, along one axis of P.
struct AxisVotes {
  int right = 0, wrong = 0;
  std::vector<std::string> wrong_ones;  ///< "liver on the left".
  bool is_reversed() const noexcept { return wrong >= 2 && wrong > 2 * right; }
};

/// Votes along x (left), y (back) and z (head).
std::array<AxisVotes, 3> vote_directions(const volume::LabelGrid& labels, const LabelTable& table);

}  // namespace trocar::anatomy::detail
