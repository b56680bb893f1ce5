#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "registration/sift3d/descriptor.h"

namespace trocar::registration::detail {

/// The descriptor of the largest product, and the largest product among descriptors of other keypoints.
struct Nearest {
  std::int32_t product = -1;  ///< Scalar product; kDescriptorNorm^2 for equal descriptors.
  std::int32_t second = -1;
  std::uint32_t index = 0;
  std::uint32_t owner = 0xffffffffU;  ///< Keypoint of the descriptor.

  void offer(std::int32_t offered, std::uint32_t offered_index, std::uint32_t offered_owner) noexcept {
    if (offered > product) {
      if (offered_owner != owner) second = product;
      product = offered;
      index = offered_index;
      owner = offered_owner;
    } else if (offered > second && offered_owner != owner) {
      second = offered;
    }
  }
  void merge(const Nearest& other) noexcept;
};

struct NearestOfBoth {
  std::vector<Nearest> of_a;  ///< Among b.
  std::vector<Nearest> of_b;  ///< Among a.
};

/// All products of two sets, exact, in blocks. `owners`: the keypoint of each descriptor (same lengths, checked).
/// Parallel, SIMD selected at run time.
NearestOfBoth find_nearest(std::span<const Descriptor> a, std::span<const std::uint32_t> owners_a,
                           std::span<const Descriptor> b, std::span<const std::uint32_t> owners_b);

}  // namespace trocar::registration::detail
