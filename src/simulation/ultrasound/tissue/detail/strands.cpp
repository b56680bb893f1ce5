#include "ultrasound/tissue/detail/strands.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace trocar::ultrasound::detail {
namespace {

constexpr double kCell_mm = 8.0;  ///< Each cube of P contains at most one strand.
constexpr double kShortest_mm = 3.0, kLongest_mm = 9.0;
constexpr double kSpacing_mm = 0.35;                        ///< Distance of its points: below half the beam's width.
constexpr double kWeakest_db = -10.0, kStrongest_db = 4.0;  ///< Level of a point (assumed); several add up.

/// Tissue at a point of P; 127 outside and in mixed cells.
std::uint8_t plain_tissue(const AcousticScene& scene, const Vec3& p_P) {
  const Vec3 index = scene.geometry.to_index(p_P);
  const volume::Index3 voxel{static_cast<std::int64_t>(std::floor(index.x())),
                             static_cast<std::int64_t>(std::floor(index.y())),
                             static_cast<std::int64_t>(std::floor(index.z()))};
  if (!scene.geometry.contains(voxel)) return 127;
  const std::uint8_t value = scene.tissue[scene.geometry.offset(voxel)];
  return (value & kMixedCell) != 0 ? 127 : value;
}

void add_strand(AcousticScene& scene, const Vec3& middle_P, Random& random) {
  const std::uint8_t tissue = plain_tissue(scene, middle_P);
  if (tissue >= scene.table.tissues.size()) return;
  const double chance = scene.table.tissues[tissue].strands_per_ml * kCell_mm * kCell_mm * kCell_mm * 1e-3;
  if (random.uniform() >= chance) return;
  const double z = random.uniform(-1.0, 1.0), turn = random.uniform(0.0, 2.0 * std::numbers::pi);
  const Vec3 axis(std::sqrt(1.0 - z * z) * std::cos(turn), std::sqrt(1.0 - z * z) * std::sin(turn), z);
  const double half_mm = 0.5 * random.uniform(kShortest_mm, kLongest_mm);
  const double level_db = random.uniform(kWeakest_db, kStrongest_db);
  for (const double end : {-half_mm, half_mm})
    if (plain_tissue(scene, middle_P + end * axis) != tissue) return;
  for (double at = -half_mm; at <= half_mm; at += kSpacing_mm) scene.points.push_back({middle_P + at * axis, level_db});
}

}  // namespace

void add_strands(AcousticScene& scene) {
  const auto& tissues = scene.table.tissues;
  if (std::none_of(tissues.begin(), tissues.end(), [](const AcousticTissue& t) { return t.strands_per_ml > 0.0; }))
    return;
  Eigen::AlignedBox3d box;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index;
    for (int a = 0; a < 3; ++a)
      index[a] = ((corner >> a) & 1) != 0 ? static_cast<double>(scene.geometry.size[static_cast<std::size_t>(a)]) : 0.0;
    box.extend(scene.geometry.to_mm(index));
  }
  const auto cell = [](double mm) { return static_cast<std::int64_t>(std::floor(mm / kCell_mm)); };
  for (std::int64_t k = cell(box.min().z()); k <= cell(box.max().z()); ++k) {
    for (std::int64_t j = cell(box.min().y()); j <= cell(box.max().y()); ++j) {
      for (std::int64_t i = cell(box.min().x()); i <= cell(box.max().x()); ++i) {
        constexpr std::int64_t kMask = 0x1fffff;
        Random random(static_cast<std::uint64_t>((i & kMask) | (j & kMask) << 21 | (k & kMask) << 42));
        const Vec3 within(random.uniform(), random.uniform(), random.uniform());
        add_strand(scene,
                   kCell_mm * (Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)) + within),
                   random);
      }
    }
  }
}

}  // namespace trocar::ultrasound::detail
