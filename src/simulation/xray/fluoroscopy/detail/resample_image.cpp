#include "xray/fluoroscopy/detail/resample_image.h"

#include <algorithm>

#include "core/parallel.h"

namespace trocar::xray::detail {
namespace {

constexpr std::size_t kGrainResampledRows = 32;

}  // namespace

std::vector<float> resample_image(const std::vector<float>& image, int columns, int rows, int new_columns,
                                  int new_rows) {
  struct Place {
    std::size_t first, second;
    float weight;
  };
  const auto place = [](int n, int fine, int coarse) {
    const double x = std::clamp((n + 0.5) * coarse / fine - 0.5, 0.0, coarse - 1.0);
    const auto first = static_cast<std::size_t>(x);
    return Place{first, std::min(first + 1, static_cast<std::size_t>(coarse - 1)),
                 static_cast<float>(x - static_cast<double>(first))};
  };
  std::vector<Place> across;
  for (int n = 0; n < new_columns; ++n) across.push_back(place(n, new_columns, columns));
  std::vector<float> made(static_cast<std::size_t>(new_columns) * static_cast<std::size_t>(new_rows));
  parallel_for(static_cast<std::size_t>(new_rows), kGrainResampledRows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const Place y = place(static_cast<int>(row), new_rows, rows);
      const float* const above = image.data() + y.first * static_cast<std::size_t>(columns);
      const float* const below = image.data() + y.second * static_cast<std::size_t>(columns);
      float* const to = made.data() + row * static_cast<std::size_t>(new_columns);
      for (std::size_t n = 0; n < across.size(); ++n) {
        const Place& x = across[n];
        const float left = above[x.first] + y.weight * (below[x.first] - above[x.first]);
        const float right = above[x.second] + y.weight * (below[x.second] - above[x.second]);
        to[n] = left + x.weight * (right - left);
      }
    }
  });
  return made;
}

}  // namespace trocar::xray::detail
