#include "anatomy/posture.h"

#include <array>

namespace trocar::anatomy {
namespace {

struct PostureRow {
  std::string_view name, words;
  std::array<double, 3> down_P;
};

constexpr std::array<PostureRow, 5> kRows{{{"supine", "lying on the back", {0, 1, 0}},
                                           {"prone", "lying on the belly", {0, -1, 0}},
                                           {"left-lateral", "lying on the left side", {1, 0, 0}},
                                           {"right-lateral", "lying on the right side", {-1, 0, 0}},
                                           {"sitting", "sitting", {0, 0, -1}}}};

const PostureRow& row_of(Posture posture) {
  return kRows[static_cast<std::size_t>(posture)];
}

}  // namespace

std::string_view posture_name(Posture posture) {
  return row_of(posture).name;
}

std::string_view posture_words(Posture posture) {
  return row_of(posture).words;
}

std::optional<Posture> find_posture(std::string_view name) {
  for (std::size_t n = 0; n < kRows.size(); ++n)
    if (kRows[n].name == name) return static_cast<Posture>(n);
  return std::nullopt;
}

Vec3 gravity_P(Posture posture) {
  const auto& down = row_of(posture).down_P;
  return {down[0], down[1], down[2]};
}

}  // namespace trocar::anatomy
