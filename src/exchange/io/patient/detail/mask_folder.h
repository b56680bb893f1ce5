#pragma once

#include <vector>

#include "anatomy/build_patient.h"

namespace trocar::io::detail {

/// The values other than 0 in the image.
std::vector<int> values_in(const volume::LabelGrid& labels);

/// An empty mask needs no voxels: a coarse grid over the same box gives its position.
volume::LabelGrid empty_over(const volume::GridGeometry& geometry);

/// Collects the masks of a folder. Masks that do not overlap share one source.
class MaskFolder {
 public:
  void add(anatomy::LabelSource source);
  std::vector<anatomy::LabelSource> take();

 private:
  std::vector<anatomy::LabelSource> joined_;
  std::vector<anatomy::LabelSource> others_;  ///< Empty masks and files of several labels.
};

}  // namespace trocar::io::detail
