#include <algorithm>
#include <cmath>

#include "phantom/structure.h"

namespace trocar::phantom {
namespace {

constexpr float kRenalFatHu = -98.0F;
const Vec3f kKidneyReach(52.0F, 48.0F, 74.0F);  ///< The kidney's fat lies within it around the centre, mm.

/// Kidney in its own frame: x away from the spine, y posterior, z up, the origin in its centre.
struct KidneyShape {
  const KidneyData& data;
  Vec3f centre;
  float sign;  ///< -1 right, 1 left.
  float scale;

  Vec3f local(const Vec3f& q) const {
    const Vec3f u = (q - centre) / scale;
    const float x = sign * u.x();
    const float turned_x = 0.82F * x + 0.57F * u.y();  // the hilum faces forward and inward
    const float turned_y = -0.57F * x + 0.82F * u.y();
    return {turned_x + 0.20F * u.z(), turned_y - 0.06F * u.z(), u.z()};  // upper pole inward and back
  }
  float outline(const Vec3f& u) const {
    const float bean = ellipsoid(u, data.radii_mm);
    const float hilum = ellipsoid(u - data.hilum_centre, data.hilum_radii_mm);
    return smooth_max(bean, -hilum, 9.0F) * scale;
  }
  float sinus(const Vec3f& u) const { return ellipsoid(u - data.sinus_centre, data.sinus_radii_mm) * scale; }
  /// Pyramids around the sinus, with their tips in it.
  float pyramids(const Vec3f& u, float wobble) const {
    const float along = std::cos(u.z() * 0.36F + wobble);
    const float around = std::cos(std::atan2(u.y(), u.x() - data.sinus_centre.x()) * 4.0F + 1.6F * wobble);
    return (0.15F - 0.6F * along - 0.5F * around) * 5.0F;
  }
};

/// Over the upper pole of a kidney, medially.
void add_adrenal_gland(Anatomy& anatomy, const Vec3f& kidney_centre, float sign) {
  const AdrenalGlandData& data = anatomy.data.adrenal_glands;
  const Vec3f top = kidney_centre + Vec3f(sign * data.top.x(), data.top.y(), data.top.z());
  const Tube gland(chain(moved(sign < 0.0F ? mirrored(data.course) : data.course, top)));
  anatomy.add_plain(
      "adrenal_gland" + side_of(sign), warped(gland.bounds()),
      [=](const Place& place) { return gland.distance(place.q); }, 85.0F);
}

void add_kidney(Anatomy& anatomy, float sign) {
  const std::string side = side_of(sign);
  Random random = anatomy.random("kidney" + side);
  const KidneyData& data = anatomy.data.kidneys;
  const Vec3f centre = varied(random, sign < 0.0F ? data.right_centre : data.left_centre, data.spread_mm);
  const KidneyShape shape{data, centre, sign, data.size.draw(random)};
  const auto& noise = anatomy.noise;
  const std::uint8_t fat = anatomy.label("fat");
  const Box bounds = warped(Box::around(centre, kKidneyReach));
  const auto outline = [=, &noise](const Place& place) {
    return shape.outline(shape.local(place.q)) + 1.3F * noise(place.p / 17.0F);
  };
  // Fat of the capsule, thicker behind, inside a thin fascia.
  const auto capsule = [=](const Place& place) {
    const Vec3f u = shape.local(place.q);
    return ellipsoid(u - shape.data.capsule_centre, shape.data.capsule_radii_mm) * shape.scale;
  };
  anatomy.add({"perirenal_fat", bounds,
               [=](const Place& place) { return std::max(capsule(place), place.cavity + 2.5F); },
               [=, &noise](const Place& place, float distance, const Brush& brush) {
                 const float fascia = brush.cover(std::abs(distance + 1.2F) - 0.35F);
                 const float strands = noise(place.p / 7.0F) / 0.10F;
                 const float stranding = 35.0F * std::max(0.0F, 1.0F - strands * strands);
                 return Paint{mix(kRenalFatHu, -25.0F, fascia) + 0.6F * stranding, fat};
               }});
  const std::uint8_t label = anatomy.label("kidney" + side);
  anatomy.add(
      {"kidney" + side, bounds, [=](const Place& place) { return std::max(outline(place), place.cavity + 3.0F); },
       [=, &noise](const Place& place, float distance, const Brush& brush) {
         const Vec3f u = shape.local(place.q);
         const float medulla = brush.cover(std::max(shape.pyramids(u, 2.2F * noise(place.p / 22.0F)), distance + 6.0F));
         float hu = mix(182.0F + 5.0F * noise(place.p / 6.0F), 157.0F, medulla);
         const float sinus = shape.sinus(u) + 2.0F * noise(place.p / 8.0F);
         const float calyces = noise(place.p / 7.5F);
         const float content = mix(kRenalFatHu + 15.0F, 35.0F, smooth_step(-0.1F, 0.25F, calyces));
         hu = mix(hu, content, brush.cover(sinus));
         return Paint{hu, label};
       }});
  add_adrenal_gland(anatomy, centre, sign);
}

}  // namespace

void add_kidneys(Anatomy& anatomy) {
  add_kidney(anatomy, -1.0F);
  add_kidney(anatomy, 1.0F);
}

void add_spleen(Anatomy& anatomy) {
  Random random = anatomy.random("spleen");
  const SpleenData& data = anatomy.data.spleen;
  const Vec3f centre = varied(random, data.centre, data.spread_mm);
  const Vec3f radii = data.radii_mm * data.size.draw(random);
  const auto& noise = anatomy.noise;
  const float fluid_mm = 6.0F * floating_share(anatomy.body);  // free fluid between spleen and wall
  anatomy.add_plain(
      "spleen", warped(Box::around(centre, radii)),
      [=, &noise, &data](const Place& place) {
        const Vec3f u = place.q - centre;
        const Vec3f turned(u.x() + 0.15F * u.z(), u.y() - 0.2F * u.z(), u.z());
        const float bulk = ellipsoid(turned, radii);
        const float hollow = ellipsoid(u - data.hollow_centre, data.hollow_radii_mm);
        const float carved = smooth_max(bulk, -hollow, 14.0F);
        const float under = smooth_max(carved, place.diaphragm + 3.6F, 5.0F);
        return smooth_max(under, place.cavity + 3.2F + fluid_mm, 5.0F) + 1.6F * noise(place.p / 24.0F);
      },
      118.0F, 4.0F, 9.0F);
}

void add_pancreas(Anatomy& anatomy) {
  Random random = anatomy.random("pancreas");
  const PancreasData& data = anatomy.data.pancreas;
  const Tube tube(chain(moved(data.course, varied(random, Vec3f::Zero(), data.spread_mm))));
  const std::uint8_t label = anatomy.label("pancreas");
  const auto& noise = anatomy.noise;
  anatomy.add({"pancreas", warped(tube.bounds()),
               [=, &noise](const Place& place) {
                 return tube.distance(place.q) + 1.7F * noise(place.p / 5.0F) + 1.2F * noise(place.p / 11.0F);
               },
               [=, &noise](const Place& place, float distance, const Brush&) {
                 // Fat between the lobules from outside.
                 const float lobules =
                     smooth_step(0.15F, 0.6F, noise(place.p / 4.2F)) * smooth_step(-9.0F, 0.0F, distance);
                 return Paint{mix(103.0F, 10.0F, lobules), label};
               }});
}

namespace {

constexpr float kGasHu = -940.0F;

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
void add_loop(Anatomy& anatomy, const std::string& name, std::vector<Cone> cones, const Folds& folds,
              const std::function<Lumen(const TubeHit&)>& lumen_at) {
  const Tube tube(std::move(cones));
  const auto& noise = anatomy.noise;
  const std::uint8_t organ = anatomy.label(name);
  const std::uint8_t gas = anatomy.label("gas");
  const std::uint8_t fat = anatomy.label("fat");
  const auto distance = [=, &noise](const Place& place, const TubeHit& hit) {
    const float fold = std::abs(std::sin(kPi * hit.arc_mm / folds.distance_mm + 1.2F * noise(place.p / 18.0F)));
    const float d = hit.distance + folds.depth_mm * (1.0F - fold) + 1.5F * noise(place.p / 14.0F);
    return smooth_max(d, place.cavity + 4.0F, 4.0F);
  };
  // Fat around the loop separates it from its neighbours; in free fluid only where it hangs on its mesentery.
  const bool has_fluid = anatomy.body.ascites_ml > 0.0;
  anatomy.add({"bowel_fat", warped(tube.bounds()),
               [=, &anatomy](const Place& place) {
                 const float around = smooth_max(tube.distance(place.q) - 1.5F, place.cavity + 3.0F, 3.0F);
                 return has_fluid ? std::max(around, mesentery_distance(anatomy, place)) : around;
               },
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
Course small_bowel_course(const SmallBowelData& data, Random& random) {
  Course knots;
  const auto jitter = [&](float mm) { return static_cast<float>(random.uniform(-mm, mm)); };
  for (int row = 0; row < data.rows; ++row)
    for (int n = 0; n < data.columns; ++n) {
      const int column = row % 2 == 0 ? n : data.columns - 1 - n;
      if (row == 0 && column < data.first_upper_column) continue;
      for (int m = 0; m < data.layers; ++m) {
        const int layer = n % 2 == 0 ? m : data.layers - 1 - m;
        const float x = data.first.x() + data.step.x() * static_cast<float>(column) +
                        data.stagger_mm * static_cast<float>((row + layer) % 2);
        const float y = data.first.y() + data.step.y() * static_cast<float>(layer);
        const float slant =
            data.slant_mm * std::sin(1.3F * static_cast<float>(column) + 2.0F * static_cast<float>(layer));
        const float z = data.first.z() + data.step.z() * static_cast<float>(row) + slant;
        knots.push_back({Vec3f(x + jitter(data.spread.x()), y + jitter(data.spread.y()), z + jitter(data.spread.z())),
                         data.radius_mm + jitter(data.radius_spread_mm)});
      }
    }
  return knots;
}

/// Loops gather about the root of the mesentery and float up in free fluid.
Course floating(const Anatomy& anatomy, Course course) {
  const float share = floating_share(anatomy.body);
  const Vec3f middle(6.0F, -38.0F, -98.0F);
  const Vec3f up = floating_mm(anatomy.body) * floating_direction(anatomy);
  for (Knot& knot : course) knot.p = middle + (1.0F - 0.2F * share) * (knot.p - middle) + up;
  return course;
}

void add_small_bowel(Anatomy& anatomy) {
  Random random = anatomy.random("small_bowel");
  const ValueNoise content(anatomy.seed ^ 0x626f776cU);
  const SmallBowelData& data = anatomy.data.small_bowel;
  add_loop(anatomy, "small_bowel", chain(floating(anatomy, small_bowel_course(data, random)), 5), data.folds,
           [content](const TubeHit& hit) {
             const float along = content(Vec3f(hit.arc_mm / 70.0F, 3.5F, 8.5F));
             return Lumen{2.1F, 98.0F, 30.0F + 22.0F * content(Vec3f(hit.arc_mm / 40.0F, 9.5F, 1.5F)),
                          along > 0.45F ? mix(-0.4F, 0.3F, 2.0F * (along - 0.45F)) : -2.0F, 0.0F};
           });
}

void add_duodenum(Anatomy& anatomy) {
  const DuodenumData& data = anatomy.data.duodenum;
  add_loop(anatomy, "duodenum", chain(data.course), data.folds, [](const TubeHit& hit) {
    return Lumen{2.6F, 95.0F, 24.0F, hit.arc_mm < 26.0F ? -0.2F : -2.0F, 0.0F};
  });
}

void add_colon(Anatomy& anatomy) {
  Random random = anatomy.random("colon");
  const ColonData& data = anatomy.data.colon;
  const auto jitter = [&](float mm) { return static_cast<float>(random.uniform(-mm, mm)); };
  const float dip = jitter(data.hanging_spread_mm);
  Course course = data.course;
  for (std::size_t n = data.hanging_knots[0]; n <= data.hanging_knots[1]; ++n)
    course[n].p += Vec3f(0.0F, -belly_bulge_mm(anatomy.body.ascites_ml), dip);
  for (Knot& knot : course) knot.p += Vec3f(jitter(data.spread.x()), jitter(data.spread.y()), jitter(data.spread.z()));
  add_loop(anatomy, "colon", chain(course), data.folds, [](const TubeHit& hit) {
    const float stool = 1.0F - smooth_step(170.0F, 220.0F, hit.arc_mm) + smooth_step(480.0F, 520.0F, hit.arc_mm);
    return Lumen{2.2F, 78.0F, 30.0F, mix(0.45F, -0.6F, clamp01(stool)), clamp01(stool)};
  });
}

}  // namespace

void add_bowel(Anatomy& anatomy) {
  add_small_bowel(anatomy);
  add_duodenum(anatomy);
  add_colon(anatomy);
}

void add_stomach(Anatomy& anatomy) {
  Random random = anatomy.random("stomach");
  const auto jitter = [&](float mm) { return static_cast<float>(random.uniform(-mm, mm)); };
  const StomachData& data = anatomy.data.stomach;
  const float fullness = 1.0F + data.radius_spread * jitter(1.0F);
  Course course = data.course;
  for (Knot& knot : course) knot.radius *= fullness;
  const Tube tube(chain(course));
  const float level_y = data.fluid_level_y_mm + jitter(data.fluid_level_spread_mm);
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

}  // namespace trocar::phantom
