#include "registration/intensity/bright_gray.h"

#include <algorithm>
#include <array>

namespace trocar::registration {

double bright_gray(const volume::LabelGrid& gray) {
  constexpr double kShare = 0.995, kLeast = 32.0;
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t level : gray.voxels) ++counts[level];
  const std::size_t total = gray.voxels.size() - counts[0];
  std::size_t below = 0;
  for (std::size_t level = 1; total > 0 && level < counts.size(); ++level) {
    below += counts[level];
    if (static_cast<double>(below) >= kShare * static_cast<double>(total))
      return std::max(kLeast, static_cast<double>(level));
  }
  return 255.0;
}

}  // namespace trocar::registration
