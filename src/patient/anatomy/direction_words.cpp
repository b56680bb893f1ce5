#include "anatomy/direction_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace trocar::anatomy {
namespace {

constexpr double kNameable = 0.5;  // rounds to 1 mm or degree

constexpr std::array<std::array<const char*, 2>, 3> kWays{{{"to the patient's right", "to the patient's left"},
                                                           {"towards the front", "towards the back"},
                                                           {"towards the feet", "towards the head"}}};

/// The two largest components, joined; `word` gives the name of an axis component.
template <class Word>
std::string join_largest(const Vec3& offset_P, double least_second, Word word) {
  std::array<Eigen::Index, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return std::abs(offset_P[a]) > std::abs(offset_P[b]); });
  const auto named = [&](Eigen::Index axis) {
    return word(axis, kWays[static_cast<std::size_t>(axis)][offset_P[axis] > 0.0 ? 1 : 0]);
  };
  const double second = std::abs(offset_P[order[1]]);
  const bool has_second = second >= least_second && second >= kSecondDirection * std::abs(offset_P[order[0]]);
  return has_second ? named(order[0]) + " and " + named(order[1]) : named(order[0]);
}

}  // namespace

std::string direction_words(const Vec3& offset_P, const char* unit) {
  return join_largest(offset_P, kNameable, [&](Eigen::Index axis, const char* way) {
    return fmt::format("{:.0f}{} {}", std::abs(offset_P[axis]), unit, way);
  });
}

std::string direction_words(const Vec3& direction_P) {
  return join_largest(direction_P, 0.0, [](Eigen::Index, const char* way) { return std::string(way); });
}

}  // namespace trocar::anatomy
