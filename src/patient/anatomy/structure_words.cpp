#include "anatomy/structure_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace trocar::anatomy {
namespace {

struct LayerWords {
  std::string_view layer, words;
};
constexpr std::array kLayers{LayerWords{"muscle", "muscle fascia"}, LayerWords{"vessel", "vessel wall"},
                             LayerWords{"bowel", "bowel wall"}, LayerWords{"bile_duct", "bile duct wall"}};

bool is_digit(char c) noexcept {
  return c >= '0' && c <= '9';
}

/// Removes the leading number and returns it without leading zeros.
std::string_view take_number(std::string_view& text) noexcept {
  const auto end = static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_digit) - text.begin());
  std::string_view number = text.substr(0, end);
  text.remove_prefix(end);
  number.remove_prefix(std::min(number.find_first_not_of('0'), number.size()));
  return number;
}

}  // namespace

std::string structure_words(std::string_view name) {
  std::string side;
  std::string rest;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find('_', begin), name.size());
    const std::string_view word = name.substr(begin, end - begin);
    begin = end + 1;
    if (word.empty()) continue;
    std::string& part = side.empty() && (word == "left" || word == "right") ? side : rest;
    if (!part.empty()) part += ' ';
    part += word;
  }
  constexpr std::string_view kVertebrae = "vertebrae ";  // of data sets: "vertebrae_L3"
  if (rest.starts_with(kVertebrae)) rest.replace(0, kVertebrae.size(), "vertebra ");
  if (side.empty() || rest.empty()) return side + rest;
  return side + ' ' + rest;
}

std::string layer_words(std::string_view layer) {
  for (const LayerWords& known : kLayers)
    if (known.layer == layer) return std::string(known.words);
  return structure_words(layer);
}

bool is_name_before(std::string_view a, std::string_view b) noexcept {
  const std::string_view whole_a = a, whole_b = b;
  while (!a.empty() && !b.empty()) {
    if (is_digit(a[0]) && is_digit(b[0])) {
      const std::string_view n = take_number(a), m = take_number(b);
      if (n.size() != m.size()) return n.size() < m.size();
      if (n != m) return n < m;
    } else {
      if (a[0] != b[0]) return a[0] < b[0];
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  if (a.empty() != b.empty()) return a.empty();
  return whole_a < whole_b;  // "rib_05" and "rib_5"
}

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
