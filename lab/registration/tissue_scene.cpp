#include "lab/registration/tissue_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace trocar::registration {
namespace {

constexpr double kVessel_db = -28.0;
constexpr double kWall_db = 6.0;
constexpr double kWall_mm = 0.8;
constexpr double kBone_db = 16.0;
constexpr double kTexture_mm = 14.0;  ///< Size of the slow variation of the tissue.
constexpr double kTexture_db = 2.0;

double distance_to_rod_mm(const Rod& rod, const Vec3& p_W) {
  return distance_mm(rod.axis_W, p_W) - rod.radius_mm;
}

/// Random values at lattice points, cubic between them; about -1..1.
double slow_noise(std::uint64_t seed, const Vec3& p) {
  const Vec3 at = p / kTexture_mm;
  const Vec3 low = at.array().floor();
  const Vec3 part = at - low;
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    std::uint64_t key = seed;
    double weight = 1.0;
    for (int a = 0; a < 3; ++a) {
      const int upper = (corner >> a) & 1;
      const double smooth = part[a] * part[a] * (3.0 - 2.0 * part[a]);
      weight *= upper != 0 ? smooth : 1.0 - smooth;
      key = mix64(key ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(low[a]) + upper + 100000));
    }
    sum += weight * (2.0 * uniform01(key, 0) - 1.0);
  }
  return sum;
}

Vec3 random_point(Random& random, const Vec3& first, const Vec3& last) {
  Vec3 p;
  for (int a = 0; a < 3; ++a) p[a] = random.uniform(first[a], last[a]);
  return p;
}

Vec3 random_direction(Random& random) {
  return Vec3(random.normal(), random.normal(), random.normal()).normalized();
}

/// A bending path of rods through the box, thinner towards its end.
void add_vessel(Random& random, const SceneOptions& options, std::vector<Rod>& rods) {
  constexpr int kParts = 9;
  constexpr double kPart_mm = 9.0, kBend = 0.45;
  Vec3 at = random_point(random, options.first_W, options.last_W);
  Vec3 direction = random_direction(random);
  const double radius_mm = random.uniform(1.8, 4.5);
  for (int part = 0; part < kParts; ++part) {
    const Vec3 next = at + kPart_mm * direction;
    rods.push_back({{at, next}, radius_mm * (1.0 - 0.05 * part)});
    at = next;
    direction = (direction + kBend * random_direction(random)).normalized();
  }
}

}  // namespace

double TissueScene::level_db(const Vec3& p_W) const noexcept {
  double level = kTexture_db * slow_noise(seed, p_W);
  for (const Ellipsoid& e : ellipsoids)
    if ((e.R_WE.transpose() * (p_W - e.centre_W)).cwiseQuotient(e.half_mm).squaredNorm() < 1.0) level = e.level_db;
  double nearest = 1e9;
  for (const Rod& rod : vessels) nearest = std::min(nearest, distance_to_rod_mm(rod, p_W));
  if (nearest < 0.0) {
    level = kVessel_db;
  } else if (nearest < kWall_mm) {
    level = kWall_db;
  }
  for (const Rod& rod : bones)
    if (distance_to_rod_mm(rod, p_W) < 0.0) level = kBone_db;
  return level;
}

TissueScene make_tissue_scene(const SceneOptions& options, std::uint64_t seed) {
  Random random(seed);
  TissueScene scene;
  scene.seed = mix64(seed);
  for (int n = 0; n < options.vessels; ++n) add_vessel(random, options, scene.vessels);
  for (int n = 0; n < options.ellipsoids; ++n) {
    Ellipsoid e;
    e.centre_W = random_point(random, options.first_W, options.last_W);
    e.R_WE = Eigen::Quaterniond(Eigen::AngleAxisd(random.uniform(0.0, std::numbers::pi), random_direction(random)))
                 .toRotationMatrix();
    for (int a = 0; a < 3; ++a) e.half_mm[a] = random.uniform(3.0, 10.0);
    e.level_db = random.uniform() < 0.5 ? random.uniform(5.0, 10.0) : random.uniform(-12.0, -6.0);
    scene.ellipsoids.push_back(e);
  }
  for (int n = 0; n < options.bones; ++n) {
    Rod rod;
    Vec3 first = random_point(random, options.first_W, options.last_W);
    const double low = options.first_W[options.bone_axis], high = options.last_W[options.bone_axis];
    first[options.bone_axis] = low + (high - low) * random.uniform(0.15, 0.4);
    Vec3 direction = random_direction(random);
    direction[options.bone_axis] *= 0.2;
    rod.axis_W = {first, first + random.uniform(25.0, 50.0) * direction.normalized()};
    rod.radius_mm = random.uniform(2.5, 4.0);
    scene.bones.push_back(rod);
  }
  return scene;
}

}  // namespace trocar::registration
