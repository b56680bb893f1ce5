#include <algorithm>
#include <cmath>
#include <numbers>

#include "anatomy/phantom/structure.h"

namespace trocar::anatomy::phantom {
namespace {

constexpr float kGasHu = -940.0F;
constexpr float kPi = std::numbers::pi_v<float>;

/// Content of a piece of bowel in supine position: gas in front (towards -y), fluid or stool behind.
struct Lumen {
  float wall_mm;
  float wall_hu;
  float fluid_hu;
  float gas_share;  ///< -1: none, 1: gas everywhere.
  float stool;      ///< 0 fluid, 1 mottled stool.
};

Paint paint_lumen(const Place& place, float distance, const Brush& brush, const Lumen& lumen, const TubeHit& hit,
                  const ValueNoise& noise, std::uint8_t organ, std::uint8_t gas) {
  const float inside = distance + lumen.wall_mm;
  const float mottle = noise(place.p / 3.6F) + 0.6F * noise(place.p / 8.0F);
  const float stool_hu = 45.0F + 25.0F * mottle - 420.0F * smooth_step(0.45F, 0.9F, mottle);
  // Folds of the mucosa extend into the lumen.
  const float folds =
      std::abs(std::sin(0.55F * hit.arc_mm)) * smooth_step(-6.5F, -1.5F, distance) * (1.0F - lumen.stool);
  const float fluid_hu = mix(lumen.fluid_hu + 6.0F * mottle, lumen.wall_hu, 0.55F * folds);
  const float content = mix(fluid_hu, stool_hu, lumen.stool);
  // The level is flat, perpendicular to gravity.
  const float level = place.p.y() - (hit.centre.y() + (lumen.gas_share - lumen.stool * 0.25F * mottle) * hit.radius);
  const float hu = mix(content, kGasHu, brush.cover(level));
  return {mix(lumen.wall_hu, hu, brush.cover(inside)), inside < 0.0F && level < 0.0F ? gas : organ};
}

/// A loop of bowel; `lumen_at` returns its content along the loop.
void add_loop(Anatomy& anatomy, const std::string& name, std::vector<Cone> cones, float haustra_mm, float haustra_depth,
              const std::function<Lumen(const TubeHit&)>& lumen_at) {
  const Tube tube(std::move(cones));
  const auto& noise = anatomy.noise;
  const std::uint8_t organ = anatomy.label(name);
  const std::uint8_t gas = anatomy.label("gas");
  const std::uint8_t fat = anatomy.label("fat");
  const auto distance = [=, &noise](const Place& place, const TubeHit& hit) {
    const float folds = std::abs(std::sin(kPi * hit.arc_mm / haustra_mm + 1.2F * noise(place.p / 18.0F)));
    const float d = hit.distance + haustra_depth * (1.0F - folds) + 1.5F * noise(place.p / 14.0F);
    return smooth_max(d, place.cavity + 4.0F, 4.0F);
  };
  // Fat around the loop separates it from its neighbours.
  anatomy.add({"bowel_fat", warped(tube.bounds()),
               [=](const Place& place) { return smooth_max(tube.distance(place.q) - 1.5F, place.cavity + 3.0F, 3.0F); },
               [=](const Place&, float, const Brush&) {
                 return Paint{-92.0F, fat};
               }});
  anatomy.add({name, warped(tube.bounds()), [=](const Place& place) { return distance(place, tube.nearest(place.q)); },
               [=, &noise](const Place& place, float d, const Brush& brush) {
                 const TubeHit hit = tube.nearest(place.q);
                 return paint_lumen(place, d, brush, lumen_at(hit), hit, noise, organ, gas);
               }});
}

/// Loops that fill the space below the pancreas: one tube in a serpentine.
std::vector<Knot> small_bowel_way(Random& random) {
  std::vector<Knot> knots;
  const auto jitter = [&](float mm) { return static_cast<float>(random.uniform(-mm, mm)); };
  constexpr int kColumns = 6;
  constexpr int kLayers = 3;
  constexpr int kRows = 4;
  constexpr int kUpperColumn = 3;  // the highest row is only left of the pancreas's head
  for (int row = 0; row < kRows; ++row)
    for (int n = 0; n < kColumns; ++n) {
      const int column = row % 2 == 0 ? n : kColumns - 1 - n;
      if (row == 0 && column < kUpperColumn) continue;
      for (int m = 0; m < kLayers; ++m) {
        const int layer = n % 2 == 0 ? m : kLayers - 1 - m;
        // Staggered, so that no row is visible in a slice.
        const float x = -50.0F + 25.0F * static_cast<float>(column) + 9.0F * static_cast<float>((row + layer) % 2);
        const float y = -68.0F + 25.0F * static_cast<float>(layer);
        const float slant = 9.0F * std::sin(1.3F * static_cast<float>(column) + 2.0F * static_cast<float>(layer));
        const float z = -16.0F - 27.0F * static_cast<float>(row) + slant;
        knots.push_back({Vec3f(x + jitter(8.0F), y + jitter(7.0F), z + jitter(10.0F)), 11.0F + jitter(2.8F)});
      }
    }
  return knots;
}

void add_small_bowel(Anatomy& anatomy) {
  Random random = anatomy.random("small_bowel");
  const ValueNoise content(anatomy.seed ^ 0x626f776cU);
  add_loop(anatomy, "small_bowel", chain(small_bowel_way(random), 5), 7.0F, 1.2F, [content](const TubeHit& hit) {
    const float along = content(Vec3f(hit.arc_mm / 70.0F, 3.5F, 8.5F));
    return Lumen{2.1F, 98.0F, 30.0F + 22.0F * content(Vec3f(hit.arc_mm / 40.0F, 9.5F, 1.5F)),
                 along > 0.45F ? mix(-0.4F, 0.3F, 2.0F * (along - 0.45F)) : -2.0F, 0.0F};
  });
  // The duodenum bends around the head of the pancreas and crosses under it.
  const std::vector<Knot> duodenum{{Vec3f(-38.0F, -46.0F, 2.0F), 13.0F},   {Vec3f(-50.0F, -28.0F, 0.0F), 13.0F},
                                   {Vec3f(-50.0F, -18.0F, -22.0F), 13.0F}, {Vec3f(-42.0F, -16.0F, -46.0F), 13.0F},
                                   {Vec3f(-16.0F, -18.0F, -56.0F), 12.0F}, {Vec3f(18.0F, -22.0F, -50.0F), 11.5F},
                                   {Vec3f(36.0F, -28.0F, -36.0F), 11.5F}};
  add_loop(anatomy, "duodenum", chain(duodenum), 8.0F, 1.0F, [](const TubeHit& hit) {
    return Lumen{2.6F, 95.0F, 24.0F, hit.arc_mm < 26.0F ? -0.2F : -2.0F, 0.0F};
  });
}

void add_colon(Anatomy& anatomy) {
  Random random = anatomy.random("colon");
  const auto jitter = [&](float mm) { return static_cast<float>(random.uniform(-mm, mm)); };
  const float dip = jitter(8.0F);
  std::vector<Knot> way{{Vec3f(-98.0F, 22.0F, -128.0F), 24.0F},       {Vec3f(-96.0F, 20.0F, -104.0F), 24.0F},
                        {Vec3f(-88.0F, 8.0F, -82.0F), 22.0F},         {Vec3f(-80.0F, -22.0F, -72.0F), 21.0F},
                        {Vec3f(-68.0F, -54.0F, -70.0F + dip), 20.0F}, {Vec3f(-38.0F, -70.0F, -52.0F + dip), 19.0F},
                        {Vec3f(0.0F, -74.0F, -34.0F + dip), 18.0F},   {Vec3f(40.0F, -72.0F, -22.0F + dip), 19.0F},
                        {Vec3f(78.0F, -56.0F, -8.0F), 19.0F},         {Vec3f(100.0F, -24.0F, 8.0F), 19.0F},
                        {Vec3f(108.0F, 6.0F, 6.0F), 18.0F},           {Vec3f(106.0F, 26.0F, -18.0F), 16.0F},
                        {Vec3f(104.0F, 28.0F, -58.0F), 14.5F},        {Vec3f(102.0F, 26.0F, -95.0F), 14.5F},
                        {Vec3f(98.0F, 24.0F, -128.0F), 15.0F}};
  for (Knot& knot : way) knot.p += Vec3f(jitter(2.5F), jitter(2.5F), jitter(3.0F));
  add_loop(anatomy, "colon", chain(way), 26.0F, 4.5F, [](const TubeHit& hit) {
    const float stool = 1.0F - smooth_step(120.0F, 170.0F, hit.arc_mm) + smooth_step(430.0F, 470.0F, hit.arc_mm);
    return Lumen{2.2F, 78.0F, 30.0F, mix(0.45F, -0.6F, clamp01(stool)), clamp01(stool)};
  });
}

}  // namespace

void add_bowel(Anatomy& anatomy) {
  add_small_bowel(anatomy);
  add_colon(anatomy);
}

void add_stomach(Anatomy& anatomy) {
  Random random = anatomy.random("stomach");
  const auto jitter = [&](float mm) { return static_cast<float>(random.uniform(-mm, mm)); };
  const float fullness = 1.0F + 0.06F * jitter(1.0F);
  std::vector<Knot> way{{Vec3f(62.0F, 18.0F, 56.0F), 26.0F},  {Vec3f(64.0F, 0.0F, 50.0F), 33.0F},
                        {Vec3f(64.0F, -26.0F, 34.0F), 31.0F}, {Vec3f(50.0F, -48.0F, 16.0F), 25.0F},
                        {Vec3f(22.0F, -58.0F, 2.0F), 20.0F},  {Vec3f(-8.0F, -56.0F, 0.0F), 16.0F},
                        {Vec3f(-28.0F, -50.0F, 3.0F), 11.0F}};
  for (Knot& knot : way) knot.radius *= fullness;
  const Tube tube(chain(way));
  const float level_y = -34.0F + jitter(5.0F);
  const auto& noise = anatomy.noise;
  const std::uint8_t stomach = anatomy.label("stomach");
  const std::uint8_t gas = anatomy.label("gas");
  anatomy.add({"stomach", warped(tube.bounds()),
               [=, &noise](const Place& place) {
                 const float d = tube.distance(place.q) + 2.0F * noise(place.p / 20.0F);
                 const float under = smooth_max(d, place.diaphragm + 5.0F, 8.0F);
                 return smooth_max(under, place.cavity + 6.0F, 8.0F);
               },
               [=, &noise](const Place& place, float distance, const Brush& brush) {
                 const float rugae = 1.4F * noise(place.p / 5.0F);
                 const float inside = distance + 4.2F + rugae;
                 const float mucosa = brush.cover(std::abs(inside - 0.8F) - 0.8F);
                 const float food = 18.0F + 34.0F * smooth_step(0.1F, 0.7F, noise.fractal(place.p, 8.0F)) *
                                                smooth_step(level_y + 8.0F, level_y + 40.0F, place.p.y());
                 const float hu = mix(food, kGasHu, brush.cover(place.p.y() - level_y));
                 return Paint{mix(mix(72.0F, 112.0F, mucosa), hu, brush.cover(inside)),
                              inside < 0.0F && place.p.y() < level_y ? gas : stomach};
               }});
}

}  // namespace trocar::anatomy::phantom
