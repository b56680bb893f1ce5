#include "registration/sift3d/detail/extrema.h"

#include <array>
#include <cmath>

#include "core/parallel.h"

namespace trocar::registration::detail {
namespace {

/// Difference of two levels, of three neighbouring k planes.
class DifferencePlanes {
 public:
  DifferencePlanes(const Octave& octave, int level, float gain)
      : gain_(gain),
        low_(octave.levels[static_cast<std::size_t>(level)].voxels.data()),
        high_(octave.levels[static_cast<std::size_t>(level) + 1].voxels.data()),
        plane_(static_cast<std::size_t>(octave.geometry.size[0] * octave.geometry.size[1])) {
    for (auto& plane : planes_) plane.resize(plane_);
  }
  void load(std::int64_t k) {
    const std::size_t begin = static_cast<std::size_t>(k) * plane_;
    std::vector<float>& plane = planes_[static_cast<std::size_t>(k % 3)];
    for (std::size_t n = 0; n < plane_; ++n) plane[n] = gain_ * (high_[begin + n] - low_[begin + n]);
  }
  const float* plane(std::int64_t k) const { return planes_[static_cast<std::size_t>(k % 3)].data(); }

 private:
  float gain_;
  const float* low_;
  const float* high_;
  std::size_t plane_;
  std::array<std::vector<float>, 3> planes_;
};

/// True if `value` is above (sign 1) or below (sign -1) all values of a 3 x 3 x 3 neighbourhood, except its own centre
/// where `is_own`. False if one is NaN.
bool exceeds(const DifferencePlanes& planes, std::int64_t k, std::size_t at, std::ptrdiff_t row, float value,
             float sign, bool is_own) {
  for (std::int64_t dk = -1; dk <= 1; ++dk) {
    const float* centre = planes.plane(k + dk) + at;
    for (std::ptrdiff_t dj = -1; dj <= 1; ++dj) {
      for (std::ptrdiff_t di = -1; di <= 1; ++di) {
        if (is_own && dk == 0 && dj == 0 && di == 0) continue;
        if (!(sign * value > sign * centre[dj * row + di])) return false;
      }
    }
  }
  return true;
}

class ExtremumSearch {
 public:
  ExtremumSearch(const Octave& octave, int scales, double scale_exponent, float least)
      : octave_(octave), scales_(scales), least_(least) {
    for (int level = 0; level < scales + 2; ++level)
      differences_.emplace_back(octave, level, static_cast<float>(std::exp2(scale_exponent * level / scales)));
  }

  void search(std::int64_t first_k, std::int64_t last_k, std::vector<Extremum>& found) {
    for (std::int64_t k = first_k - 1; k < first_k + 1; ++k) load(k);
    for (std::int64_t k = first_k; k < last_k; ++k) {
      load(k + 1);
      search_plane(k, found);
    }
  }

 private:
  void load(std::int64_t k) {
    for (DifferencePlanes& planes : differences_) planes.load(k);
  }

  void search_plane(std::int64_t k, std::vector<Extremum>& found) const {
    const auto& size = octave_.geometry.size;
    for (std::int64_t j = 1; j + 1 < size[1]; ++j) {
      for (int level = 1; level <= scales_; ++level) {
        const auto row = static_cast<std::size_t>(j * size[0]);
        const float* values = differences_[static_cast<std::size_t>(level)].plane(k) + row;
        for (std::int64_t i = 1; i + 1 < size[0]; ++i) {
          const float value = values[i];
          if (std::abs(value) >= least_ && is_extremum(k, row + static_cast<std::size_t>(i), level, value))
            found.push_back({{i, j, k}, level});
        }
      }
    }
  }

  bool is_extremum(std::int64_t k, std::size_t at, int level, float value) const {
    const float sign = value > 0.0F ? 1.0F : -1.0F;
    const auto row = static_cast<std::ptrdiff_t>(octave_.geometry.size[0]);
    const auto l = static_cast<std::size_t>(level);
    return exceeds(differences_[l], k, at, row, value, sign, true) &&
           exceeds(differences_[l - 1], k, at, row, value, sign, false) &&
           exceeds(differences_[l + 1], k, at, row, value, sign, false);
  }

  const Octave& octave_;
  int scales_;
  float least_;
  std::vector<DifferencePlanes> differences_;
};

}  // namespace

std::vector<Extremum> find_extrema(const Octave& octave, int scales, double scale_exponent, float least) {
  const std::int64_t planes = octave.geometry.size[2] - 2;
  if (planes <= 0) return {};
  constexpr std::int64_t kPlanesTogether = 8;
  const auto parts = static_cast<std::size_t>((planes + kPlanesTogether - 1) / kPlanesTogether);
  std::vector<std::vector<Extremum>> found(parts);
  parallel_for(parts, 1, [&](std::size_t first, std::size_t last) {
    ExtremumSearch search(octave, scales, scale_exponent, least);
    for (std::size_t part = first; part < last; ++part) {
      const std::int64_t begin = 1 + static_cast<std::int64_t>(part) * kPlanesTogether;
      search.search(begin, std::min(begin + kPlanesTogether, planes + 1), found[part]);
    }
  });
  std::vector<Extremum> extrema;
  for (const auto& part : found) extrema.insert(extrema.end(), part.begin(), part.end());
  return extrema;
}

}  // namespace trocar::registration::detail
