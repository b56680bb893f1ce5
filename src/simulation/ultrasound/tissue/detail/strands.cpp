#include "ultrasound/tissue/detail/strands.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "volume/distance.h"
#include "volume/morphology.h"

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

namespace {

constexpr double kLeastKidney_ml = 30.0;  ///< Smaller pieces, and kidneys mostly beyond the CT, stay as they are.
constexpr double kCortex_mm = 6.5;        ///< Thickness (radiology: 5..10 mm).
constexpr double kCoreShare = 0.78;       ///< Depth of the middle of a kidney that counts as sinus, of the greatest.
constexpr double kLeastCore_mm = 15.0;
constexpr double kClosing_mm = 10.0;  ///< Half of the opening that belongs to the sinus.
/// Pyramids: 8 to 18 in a kidney (anatomy). Rows along it, and pyramids around it, by their distance.
constexpr double kRow_mm = 15.0, kAround_rad = std::numbers::pi / 3.0;
constexpr double kBase_mm = 6.5, kTip_mm = 2.5;  ///< Radii at the cortex and at the sinus (assumed).

volume::Index3 shifted(const volume::Index3& ijk, const volume::Index3& by) {
  return {ijk[0] + by[0], ijk[1] + by[1], ijk[2] + by[2]};
}

struct Tissues {
  std::uint8_t kidney, pyramid, sinus, fat, soft_tissue;
};

std::optional<Tissues> find_tissues(const AcousticTable& table) {
  const auto kidney = table.find("kidney"), pyramid = table.find("kidney_pyramid"), sinus = table.find("renal_sinus"),
             fat = table.find("adipose"), soft_tissue = table.find("soft_tissue");
  if (!kidney || !pyramid || !sinus || !fat || !soft_tissue) return std::nullopt;
  return Tissues{*kidney, *pyramid, *sinus, *fat, *soft_tissue};
}

/// A mask on a part of a larger grid.
struct Part {
  volume::MaskGrid mask;
  volume::Index3 low{};  ///< Its first voxel in the larger grid.
};

/// The voxels of a grid for which `is_wanted(offset)`, with a margin around them; empty if there are none.
template <class Wanted>
std::optional<Part> cut_out(const volume::GridGeometry& grid, double margin_mm, const Wanted& is_wanted) {
  volume::Index3 low = grid.size, high{};
  for (std::int64_t k = 0; k < grid.size[2]; ++k) {
    for (std::int64_t j = 0; j < grid.size[1]; ++j) {
      const std::size_t row = grid.offset({0, j, k});
      for (std::int64_t i = 0; i < grid.size[0]; ++i) {
        if (!is_wanted(row + static_cast<std::size_t>(i))) continue;
        const volume::Index3 ijk{i, j, k};
        for (std::size_t a = 0; a < 3; ++a) {
          low[a] = std::min(low[a], ijk[a]);
          high[a] = std::max(high[a], ijk[a]);
        }
      }
    }
  }
  if (low[0] > high[0]) return std::nullopt;
  Part part;
  volume::GridGeometry box = grid;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto margin = static_cast<std::int64_t>(std::ceil(margin_mm / grid.spacing_mm[static_cast<Eigen::Index>(a)]));
    part.low[a] = std::max<std::int64_t>(low[a] - margin, 0);
    box.size[a] = std::min(high[a] + margin + 1, grid.size[a]) - part.low[a];
  }
  part.mask = volume::MaskGrid(box, 0);
  for (std::size_t at = 0; at < part.mask.voxels.size(); ++at)
    part.mask.voxels[at] = is_wanted(grid.offset(shifted(box.index_of(at), part.low))) ? 1 : 0;
  return part;
}

/// Length axis of a mask, and its centre, in the mask's voxel axes (mm).
struct Axis {
  Vec3 centre = Vec3::Zero(), along = Vec3::UnitZ();
};
Axis axis_of(const volume::MaskGrid& mask) {
  Vec3 sum = Vec3::Zero();
  Mat3 squares = Mat3::Zero();
  double n = 0.0;
  for (std::size_t at = 0; at < mask.voxels.size(); ++at) {
    if (mask.voxels[at] == 0) continue;
    const Vec3 p = volume::to_vec3(mask.geometry.index_of(at)).cwiseProduct(mask.geometry.spacing_mm);
    sum += p;
    squares += p * p.transpose();
    n += 1.0;
  }
  Axis axis;
  axis.centre = sum / n;
  const Mat3 spread = squares / n - axis.centre * axis.centre.transpose();
  axis.along = Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors().col(2);
  return axis;
}

/// Distance from the axis of the nearest pyramid, mm, at a point `depth_mm` below the surface.
double from_pyramid_mm(const Axis& axis, const Vec3& p) {
  const Vec3 side = axis.along.unitOrthogonal(), other = axis.along.cross(side);
  const Vec3 from = p - axis.centre;
  const double along = from.dot(axis.along), x = from.dot(side), y = from.dot(other);
  const double row = std::round(along / kRow_mm);
  const double shift = std::abs(std::fmod(row, 2.0)) > 0.5 ? 0.5 * kAround_rad : 0.0;
  const double angle = std::atan2(y, x) - shift;
  const double off_rad = angle - kAround_rad * std::round(angle / kAround_rad);
  return std::hypot(along - row * kRow_mm, std::hypot(x, y) * std::sin(off_rad));
}

void divide(const Part& part, const Tissues& tissues, AcousticScene& scene) {
  const volume::FloatGrid distance = volume::signed_distance_mm(part.mask);  // negative inside
  const volume::MaskGrid closed = volume::erode(volume::dilate(part.mask, kClosing_mm), kClosing_mm);
  double greatest_mm = 0.0;
  for (const float d : distance.voxels) greatest_mm = std::max(greatest_mm, -static_cast<double>(d));
  const double core_mm = std::max(kCoreShare * greatest_mm, kLeastCore_mm);
  const Axis axis = axis_of(part.mask);
  for (std::size_t at = 0; at < distance.voxels.size(); ++at) {
    const volume::Index3 ijk = distance.geometry.index_of(at);
    std::uint8_t& tissue = scene.tissue[scene.geometry.offset(shifted(ijk, part.low))];
    const double depth_mm = -static_cast<double>(distance.voxels[at]);
    if (part.mask.voxels[at] == 0) {
      if (closed.voxels[at] != 0 && (tissue == tissues.fat || tissue == tissues.soft_tissue)) tissue = tissues.sinus;
    } else if (depth_mm > core_mm) {
      tissue = tissues.sinus;
    } else if (depth_mm > kCortex_mm) {
      const Vec3 p = volume::to_vec3(ijk).cwiseProduct(distance.geometry.spacing_mm);
      const double inwards = std::min((depth_mm - kCortex_mm) / (core_mm - kCortex_mm), 1.0);
      if (from_pyramid_mm(axis, p) < std::lerp(kBase_mm, kTip_mm, inwards)) tissue = tissues.pyramid;
    }
  }
}

}  // namespace

void add_kidney_parts(AcousticScene& scene) {
  const auto tissues = find_tissues(scene.table);
  if (!tissues) return;
  constexpr double kMargin_mm = 2.0 * kClosing_mm + 2.0;
  const auto both =
      cut_out(scene.geometry, kMargin_mm, [&](std::size_t at) { return scene.tissue[at] == tissues->kidney; });
  if (!both) return;
  const volume::Components found = volume::connected_components(both->mask);
  const auto least = static_cast<std::size_t>(kLeastKidney_ml * 1000.0 / scene.geometry.voxel_volume_mm3());
  for (std::size_t n = 0; n < found.voxel_counts.size() && found.voxel_counts[n] >= least; ++n) {
    const auto id = static_cast<std::int32_t>(n + 1);
    auto one = cut_out(both->mask.geometry, kMargin_mm, [&](std::size_t at) { return found.ids.voxels[at] == id; });
    if (!one) continue;
    one->low = shifted(one->low, both->low);
    divide(*one, *tissues, scene);
  }
}

}  // namespace trocar::ultrasound::detail
