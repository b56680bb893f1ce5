#pragma once

#include <algorithm>
#include <array>

#include "motion/patient_motion.h"

namespace trocar::ultrasound::detail {

/// Where the patient moves: fills shift[a][s] with how far, in voxels along axis a, the tissue at rest of sample s is
/// from the sample's place now. `index_now(s)`: place of a sample in voxels of a grid; `to_mm` and `to_index` convert
/// between voxels and the patient. Exact every kExact samples; linear between two whose tissue is of one region, else
/// exact.
template <class IndexNow, class ToMm, class ToIndex, class Shifts>
void find_rest_shifts(const motion::PatientMotion& motion, int samples, const IndexNow& index_now, const ToMm& to_mm,
                      const ToIndex& to_index, Shifts& shift) noexcept {
  constexpr int kExact = 8;
  struct Node {
    Vec3 shift;
    int region;
  };
  const auto node_at = [&](int s) -> Node {
    const Vec3 index = index_now(s);
    const Vec3 p_A = motion.to_rest(to_mm(index));
    return {to_index(p_A) - index, motion.region(p_A)};
  };
  Node before = node_at(0);
  for (int from = 0; from < samples; from += kExact) {
    const Node behind = node_at(std::min(from + kExact, samples - 1));
    for (int part = 0; part < kExact && from + part < samples; ++part) {
      const double t = static_cast<double>(part) / std::max(std::min(kExact, samples - 1 - from), 1);
      const Vec3 here = before.region == behind.region ? Vec3(before.shift + t * (behind.shift - before.shift))
                                                       : node_at(from + part).shift;
      for (std::size_t a = 0; a < 3; ++a)
        shift[a][static_cast<std::size_t>(from + part)] = static_cast<float>(here[static_cast<Eigen::Index>(a)]);
    }
    before = behind;
  }
}

}  // namespace trocar::ultrasound::detail
