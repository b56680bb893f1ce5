#include "anatomy/phantom/free_fluid.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"

namespace trocar::anatomy::phantom {
namespace {

constexpr float kFluidHu = 8.0F, kTextureHu = 3.0F;
constexpr float kFasciaMm = 2.2F;          ///< Inside the cavity: transversalis fascia and peritoneum.
constexpr float kBelowDiaphragmMm = 3.2F;  ///< Below its upper surface.
constexpr float kFloor = -238.0F;          ///< The pouch in front of the rectum.
constexpr float kSampleMm = 5.0F;

/// The peritoneal cavity: in front of the spine's great vessels, beside the colon far back, down to the pouch in front
/// of the rectum.
float peritoneal_space(const Anatomy& anatomy, const Place& place) {
  const Vec3f& p = place.p;
  const float wave = anatomy.noise(p / 30.0F);
  const float beside = smooth_step(22.0F, 98.0F, std::abs(p.x()) + 10.0F * wave);
  const float pelvis = smooth_step(-128.0F, -196.0F, p.z() + 12.0F * wave);
  const float behind = mix(mix(-18.0F, 48.0F, beside), 26.0F, pelvis) + 6.0F * wave;
  const float inside = smooth_max(place.cavity + kFasciaMm, place.diaphragm + kBelowDiaphragmMm, 6.0F);
  return smooth_max(smooth_max(inside, 0.62F * (p.y() - behind), 8.0F), kFloor - p.z(), 8.0F);
}

/// Bowel and mesentery that stay together.
float mesentery(const Anatomy& anatomy, const Place& place) {
  const Vec3f centre = Vec3f(6.0F, -38.0F, -98.0F) + floating_mm(anatomy.body) * floating_direction(anatomy);
  const float share = floating_share(anatomy.body);
  const Vec3f radii = Vec3f(92.0F, 50.0F, 96.0F) * (1.0F - 0.22F * share);
  return ellipsoid(place.q - centre, radii) + 5.0F * anatomy.noise(place.p / 24.0F);
}

}  // namespace

float mesentery_distance(const Anatomy& anatomy, const Place& place) {
  return mesentery(anatomy, place);
}

FreeFluid::FreeFluid(Anatomy& anatomy) {
  if (anatomy.body.ascites_ml <= 0.0) return;
  level_ = std::make_shared<Level>();
  index_ = anatomy.structures.size();
  const Vec3f down = gravity_P(anatomy.posture).cast<float>();
  anatomy.add_plain(
      "ascites", whole_box(),
      [level = level_, down, &anatomy](const Place& place) {
        const float space = peritoneal_space(anatomy, place);
        if (space > 20.0F) return space;
        return std::max({space, -mesentery(anatomy, place), level->below_mm - place.p.dot(down)});
      },
      kFluidHu, kTextureHu, 10.0F);
}

double FreeFluid::settle(Anatomy& anatomy) {
  if (!level_) return 0.0;
  const Structure& fluid = anatomy.structures[index_];
  level_->below_mm = -1e4F;  // everything
  const Box& box = anatomy.torso.box();
  const Vec3f down = gravity_P(anatomy.posture).cast<float>();
  const auto layers = static_cast<std::size_t>((box.high.z() - box.low.z()) / kSampleMm);
  std::vector<std::vector<float>> found(layers);
  const auto is_covered = [&](const Place& place) {
    const Box here{place.p, place.p};
    for (std::size_t n = index_ + 1; n < anatomy.structures.size(); ++n) {
      const Structure& s = anatomy.structures[n];
      if (s.bounds.overlaps(here) && s.distance(place) < 0.0F) return true;
    }
    return false;
  };
  parallel_for(layers, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k)
      for (float y = box.low.y(); y < box.high.y(); y += kSampleMm)
        for (float x = box.low.x(); x < box.high.x(); x += kSampleMm) {
          const Vec3f p(x, y, box.low.z() + (static_cast<float>(k) + 0.5F) * kSampleMm);
          const Place place = anatomy.torso.at(p);
          if (fluid.distance(place) < 0.0F && !is_covered(place)) found[k].push_back(p.dot(down));
        }
  });
  std::vector<float> depths;
  for (const auto& layer : found) depths.insert(depths.end(), layer.begin(), layer.end());
  std::sort(depths.begin(), depths.end(), std::greater<>());
  const double sample_ml = std::pow(static_cast<double>(kSampleMm * anatomy.scale()), 3.0) / 1000.0;
  const auto wanted = static_cast<std::size_t>(anatomy.body.ascites_ml / sample_ml);
  if (wanted < depths.size()) level_->below_mm = depths[wanted];
  return static_cast<double>(std::min(wanted, depths.size())) * sample_ml;
}

float floating_share(const BodyParameters& body) {
  constexpr double kAllFloatsMl = 3000.0;
  return static_cast<float>(std::clamp(body.ascites_ml / kAllFloatsMl, 0.0, 1.0));
}

float floating_mm(const BodyParameters& body) {
  return 14.0F * floating_share(body) + 0.6F * belly_bulge_mm(body.ascites_ml);
}

Vec3f floating_direction(const Anatomy& anatomy) {
  return -gravity_P(anatomy.posture).cast<float>();
}

}  // namespace trocar::anatomy::phantom
