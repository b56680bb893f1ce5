#include "phantom/torso.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"

namespace trocar::phantom {
namespace {

constexpr float kLatticeMm = 4.0F;
constexpr float kMargin = 8.0F;  ///< The lattice extends beyond the box, so that nothing is extrapolated.
constexpr float kWarpMm = 4.5F;
constexpr float kWarpSizeMm = 75.0F;

// Shape of the skin's contour in a slice.
constexpr float kAnteriorExponent = 2.25F;
constexpr float kPosteriorExponent = 2.6F;
constexpr SeedRange kWavePhases{-3.14, 3.14};
constexpr float kWaveTwistPerMm = 0.012F;  ///< rad.
constexpr float kFlexedFurrow = 0.8F;      ///< Share of the furrow that is gone when the back is bent.
constexpr float kLeastCavityMm = 30.0F;    ///< Radius of the cavity; the pelvis is narrow.
constexpr float kNavelRadiusMm = 110.0F;   ///< Of the body there: mm a rad.

// Subcutaneous fat grows with the body mass index: about 12 % of the reference for each kg/m^2 [assumed].
constexpr double kReferenceIndex = 24.3;
constexpr double kFatPerIndex = 0.12;
constexpr float kLeastFatness = 0.35F, kMostFatness = 3.4F;
constexpr float kLeastFatMm = 3.0F;   ///< With the skin.
constexpr float kFemaleFat = 0.2F;    ///< Women have more of it.
constexpr float kFemaleHipMm = 7.0F;  ///< Wider on each side.
/// Where the reference has hardly any fat, in the middle of the back, a heavier body still has some.
constexpr float kBackFatMm = 5.0F;

float body_fat(const BodyParameters& body) {
  const auto by_weight = static_cast<float>(kFatPerIndex * (body.body_mass_index() - kReferenceIndex));
  return by_weight + (body.sex == Sex::kFemale ? kFemaleFat : 0.0F);
}

// Free fluid lifts the belly's front. Above the first half litre, which finds room between the organs, the front of
// about 0.075 m^2 moves outwards.
constexpr double kRoomMl = 500.0;
constexpr double kFrontMm2 = 75000.0;

/// Radius of a superellipse |x/a|^n + |y/b|^n = 1 at the angle phi.
float superellipse(float phi, float a, float b, float exponent) {
  const float u = std::abs(std::sin(phi)) / a;
  const float v = std::abs(std::cos(phi)) / b;
  return std::pow(std::pow(u, exponent) + std::pow(v, exponent), -1.0F / exponent);
}

/// One contour of a slice as a polygon, with the factor that converts the distance in the slice to that in space.
struct SliceContour {
  static constexpr std::size_t kPoints = 200;
  std::array<float, kPoints> x, y, slope_factor;

  template <class Radius>
  SliceContour(const Radius& radius, float z) {
    for (std::size_t n = 0; n < kPoints; ++n) {
      const float phi = 2.0F * kPi * static_cast<float>(n) / static_cast<float>(kPoints) - kPi;
      const float r = radius(phi, z);
      const float slope = 0.5F * (radius(phi, z + 1.0F) - radius(phi, z - 1.0F));
      x[n] = r * std::sin(phi);
      y[n] = r * std::cos(phi);
      slope_factor[n] = 1.0F / std::sqrt(1.0F + slope * slope);
    }
  }

  /// Signed distance in space from a point of the slice.
  float distance(float px, float py) const {
    constexpr std::size_t kCoarse = 4;
    std::size_t near = 0;
    float least = std::numeric_limits<float>::infinity();
    const auto look_at = [&](std::size_t n) {
      const float square = (x[n] - px) * (x[n] - px) + (y[n] - py) * (y[n] - py);
      if (square < least) {
        least = square;
        near = n;
      }
    };
    for (std::size_t n = 0; n < kPoints; n += kCoarse) look_at(n);
    const std::size_t middle = near + kPoints;
    for (std::size_t n = middle - kCoarse; n <= middle + kCoarse; ++n) look_at(n % kPoints);
    const float before = to_edge((near + kPoints - 1) % kPoints, near, px, py);
    const float after = to_edge(near, (near + 1) % kPoints, px, py);
    return (std::abs(before) < std::abs(after) ? before : after) * slope_factor[near];
  }

 private:
  /// Signed distance to an edge; the inside is to the right of the direction of travel.
  float to_edge(std::size_t a, std::size_t b, float px, float py) const {
    const float dx = x[b] - x[a];
    const float dy = y[b] - y[a];
    const float ux = px - x[a];
    const float uy = py - y[a];
    const float t = clamp01((ux * dx + uy * dy) / (dx * dx + dy * dy));
    return std::copysign(std::hypot(ux - t * dx, uy - t * dy), uy * dx - ux * dy);
  }
};

}  // namespace

float belly_bulge_mm(double ascites_ml) {
  return static_cast<float>(std::max(0.0, ascites_ml - kRoomMl) * 1000.0 / kFrontMm2);
}

TorsoContours::TorsoContours(std::uint64_t seed, const TorsoData& data, const BodyParameters& body) : data_(data) {
  Random random(seed ^ 0x7072736fU);
  half_width_ = data.half_width_mm.draw(random);
  half_depth_ = data.half_depth_mm.draw(random);
  fatness_ = std::clamp(data.fat.factor.draw(random) + body_fat(body), kLeastFatness, kMostFatness);
  flexion_ = static_cast<float>(body.flexion);
  hip_mm_ = body.sex == Sex::kFemale ? kFemaleHipMm : 0.0F;
  bulge_mm_ = belly_bulge_mm(body.ascites_ml);
  dome_mm_ = data.diaphragm.dome_spread_mm.draw(random);
  for (std::size_t n = 0; n < 3; ++n) {
    wave_mm_[n] = data.waves_mm.draw(random) / static_cast<float>(n + 1);
    wave_phase_[n] = kWavePhases.draw(random);
  }
}

float TorsoContours::reference_radius(float phi, float z) const {
  const TorsoData::Skin& skin = data_.skin;
  const TorsoData::Pelvis& pelvis = data_.pelvis;
  const float side = std::abs(phi);
  const float a = half_width_ - (skin.waist_z.at(z) + skin.chest_taper_z.at(z)) + pelvis.hip_z.at(z) +
                  hip_mm_ * pelvis.hip_z.shape(z);
  const float belly = half_depth_ - skin.chest_depth_z.at(z) + skin.belly_z.at(z) - pelvis.lower_belly_z.at(z);
  const float anterior = superellipse(phi, a, belly, kAnteriorExponent);
  const float posterior = superellipse(phi, a, data_.back_depth_mm, kPosteriorExponent);
  float r = side > 0.5F * kPi ? anterior : posterior;
  const float x = r * std::sin(side);
  // The furrow over the spine between the erector muscles, and shallow furrows beside the rectus.
  const float furrow =
      (skin.spinal_furrow.height - skin.spinal_furrow_chest_z.at(z)) * (1.0F - kFlexedFurrow * flexion_);
  r -= (furrow + pelvis.cleft_z.at(z)) * (side < 0.5F * kPi ? skin.spinal_furrow.shape(x) : 0.0F);
  r += skin.erector.at(side) + pelvis.buttock_z.at(z) * pelvis.buttock.shape(side);
  if (side > 0.5F * kPi) {
    r -= skin.linea_alba.at(x);
    r -= skin.umbilicus.at(std::hypot(x, z - data_.umbilicus_z_mm));
  }
  for (std::size_t n = 0; n < 3; ++n)
    r += wave_mm_[n] * std::sin(static_cast<float>(n + 2) * phi + wave_phase_[n] + kWaveTwistPerMm * z);
  return r + bulge_mm(phi, z);
}

float TorsoContours::bulge_mm(float phi, float z) const {
  if (bulge_mm_ == 0.0F) return 0.0F;
  const TorsoData::Pelvis& pelvis = data_.pelvis;
  return bulge_mm_ * pelvis.bulge.shape(std::abs(phi)) * pelvis.bulge_z.shape(z);
}

float TorsoContours::skin_radius(float phi, float z) const {
  const float back = kBackFatMm * bump(phi, 0.0F, 0.8F);
  return reference_radius(phi, z) + (fatness_ - 1.0F) * (fat_mm(phi, z) + back);
}

float TorsoContours::fat_mm(float phi, float z) const {
  const TorsoData::Fat& fat = data_.fat;
  const float side = std::abs(phi);
  const float chest = fat.chest_z.share(z);
  const float flank = fat.flank.at(side) * mix(1.0F, fat.flank_chest_share, chest);
  const float loin = fat.loin.at(side) * (1.0F - fat.loin_z.share(z));
  const float front = mix(fat.front_mm[0], fat.front_mm[1], chest) * fat.front.shape(side);
  const float navel = fat.umbilicus.at(std::hypot((kPi - side) * kNavelRadiusMm, z - data_.umbilicus_z_mm));
  const float hip = data_.pelvis.hip_fat_z.at(z) * bump(side, 0.5F * kPi, 0.9F);
  return std::max(fat.least_mm + flank + loin + front + hip + navel, kLeastFatMm);
}

float TorsoContours::muscle_mm(float phi, float z) const {
  const TorsoData::Muscle& muscle = data_.muscle;
  const float side = std::abs(phi);
  const float chest = muscle.chest_z.share(z);
  const float back = mix(muscle.back_mm[0], muscle.back_mm[1], chest) * bump(side, 0.0F, muscle.back_width);
  const float lateral = mix(muscle.lateral_mm[0], muscle.lateral_mm[1], chest) * muscle.lateral.shape(side);
  const float median = muscle.linea_alba_mm * bump(side, kPi, muscle.linea_alba_width);
  // The wall of the pelvis: gluteal muscles, bone, iliacus and the muscles of the pelvic wall.
  const TorsoData::Pelvis& pelvis = data_.pelvis;
  const float hips = pelvis.upper_wall_z.at(z) + pelvis.lower_wall_z.at(z);
  const float seat = pelvis.back_wall_z.at(z) * bump(side, 0.0F, pelvis.back_wall_width);
  return muscle.least_mm + back + lateral + median + hips * pelvis.wall.shape(side) + seat;
}

float TorsoContours::wall_radius(float phi, float z) const {
  return reference_radius(phi, z) - fat_mm(phi, z);
}

float TorsoContours::cavity_radius(float phi, float z) const {
  return smooth_max(wall_radius(phi, z) - muscle_mm(phi, z), kLeastCavityMm, 24.0F);
}

float TorsoContours::diaphragm_height(float x, float y, float cavity) const {
  const TorsoData::Diaphragm& diaphragm = data_.diaphragm;
  const float side = std::atan2(std::abs(x), y);
  const float rim = diaphragm.rim_back_mm + diaphragm.rim_side.at(side) + diaphragm.rim_front.at(side);
  const float right = diaphragm.right_dome_x.at(x) * diaphragm.right_dome_y.shape(y);
  const float left = diaphragm.left_dome_x.at(x) * diaphragm.left_dome_y.shape(y);
  const float dome = diaphragm.dome_mm + dome_mm_ + right + left;
  const float inward = std::max(-cavity, 0.0F);
  return mix(rim, dome, 1.0F - std::exp(-inward / diaphragm.rise_mm));
}

Vec3f TorsoContours::on_cavity(float phi, float z, float outward_mm) const {
  const float r = cavity_radius(phi, z) + outward_mm;
  return {r * std::sin(phi), r * std::cos(phi), z};
}

Torso::Torso(std::uint64_t seed, const TorsoData& data, const BodyParameters& body, SpineCurve spine, const Box& box)
    : contours_(seed, data, body), spine_(std::move(spine)), box_(box), corner_(box.low - Vec3f::Constant(kMargin)) {
  const Vec3f extent = box.high - box.low + Vec3f::Constant(2.0F * kMargin);
  for (int a = 0; a < 3; ++a)
    size_[static_cast<std::size_t>(a)] = static_cast<std::int64_t>(std::ceil(extent[a] / kLatticeMm)) + 1;
  nodes_.resize(static_cast<std::size_t>(size_[0] * size_[1] * size_[2]));
  const ValueNoise warp(seed ^ 0x77617270U);
  parallel_for(static_cast<std::size_t>(size_[2]), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) fill_slice(static_cast<std::int64_t>(k), warp);
  });
}

void Torso::fill_slice(std::int64_t k, const ValueNoise& warp) {
  const float z = corner_.z() + static_cast<float>(k) * kLatticeMm;
  const SliceContour skin([&](float phi, float height) { return contours_.skin_radius(phi, height); }, z);
  const SliceContour wall([&](float phi, float height) { return contours_.wall_radius(phi, height); }, z);
  const SliceContour cavity([&](float phi, float height) { return contours_.cavity_radius(phi, height); }, z);
  const auto columns = static_cast<std::size_t>(size_[0]);
  const auto rows = static_cast<std::size_t>(size_[1]);
  Node* const slice = &nodes_[static_cast<std::size_t>(k) * columns * rows];
  std::vector<float> height(columns * rows);
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const float x = corner_.x() + static_cast<float>(i) * kLatticeMm;
      const float y = corner_.y() + static_cast<float>(j) * kLatticeMm;
      Node& node = slice[j * columns + i];
      node.setZero();
      node.head<3>() << skin.distance(x, y), wall.distance(x, y), cavity.distance(x, y);
      node.segment<3>(7) = spine_.straighten(Vec3f(x, y, z)).array();
      height[j * columns + i] = contours_.diaphragm_height(x, y, node[2]);
      const Vec3f cell = Vec3f(x, y, z) / kWarpSizeMm;
      for (int a = 0; a < 3; ++a) node[4 + a] = kWarpMm * warp(cell + Vec3f::Constant(7.3F * static_cast<float>(a)));
    }
  // The distance from the diaphragm is the height difference corrected for its slope.
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const auto slope = [&](std::size_t low, std::size_t high, std::size_t steps) {
        return (height[high] - height[low]) / (kLatticeMm * static_cast<float>(steps));
      };
      const std::size_t i0 = i > 0 ? i - 1 : i;
      const std::size_t i1 = std::min(i + 1, columns - 1);
      const std::size_t j0 = j > 0 ? j - 1 : j;
      const std::size_t j1 = std::min(j + 1, rows - 1);
      const float gx = slope(j * columns + i0, j * columns + i1, i1 - i0);
      const float gy = slope(j0 * columns + i, j1 * columns + i, j1 - j0);
      slice[j * columns + i][3] = (z - height[j * columns + i]) / std::sqrt(1.0F + gx * gx + gy * gy);
    }
}

Place Torso::at(const Vec3f& p) const {
  const Vec3f index = (p - corner_) / kLatticeMm;
  std::array<std::int64_t, 3> low;
  std::array<float, 3> t;
  for (int a = 0; a < 3; ++a) {
    const auto n = static_cast<std::size_t>(a);
    low[n] = std::clamp(static_cast<std::int64_t>(index[a]), std::int64_t{0}, size_[n] - 2);
    t[n] = clamp01(index[a] - static_cast<float>(low[n]));
  }
  const Node* corner = &nodes_[static_cast<std::size_t>((low[2] * size_[1] + low[1]) * size_[0] + low[0])];
  const auto row = [&](const Node* node) -> Node { return node[0] + (node[1] - node[0]) * t[0]; };
  const auto plane = [&](const Node* node) -> Node {
    const Node a = row(node);
    return a + (row(node + size_[0]) - a) * t[1];
  };
  const Node below = plane(corner);
  const Node v = below + (plane(corner + size_[0] * size_[1]) - below) * t[2];
  return {p, p + Vec3f(v[4], v[5], v[6]), v[0], v[1], v[2], v[3], Vec3f(v[7], v[8], v[9])};
}

}  // namespace trocar::phantom
