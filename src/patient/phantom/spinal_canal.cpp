#include <algorithm>
#include <cmath>
#include <vector>

#include "phantom/skeleton.h"

namespace trocar::phantom {
namespace {

// Thickness of the ligamentum flavum at L3/4: 3.5 to 4 mm in adults without stenosis (CT of 40 to 60 year old: Fukuyama
// et al., J Spinal Disord 8:344, 1995). The fat behind the sac is 4 to 6 mm between two laminae and vanishes under
// them.
constexpr float kFlavumMm = 3.7F;
constexpr float kFlavumHalfWidth = 13.0F;
constexpr float kFatBehindMm = 4.2F, kFatLeastMm = 0.9F, kFatInFrontMm = 1.4F;
// The anterior plexus lies in front of the sac, at its sides more than in the midline. Share of the sac's half depth
// from which it begins: assumed.
constexpr float kVeinsFrontShare = 0.35F;
constexpr float kSacEnd = -192.0F;  ///< S2.
constexpr float kDuraMm = 0.4F;
constexpr float kTopMm = 170.0F;

constexpr float kSpinalFatHu = -95.0F, kLigamentHu = 78.0F, kFlavumHu = 92.0F, kSpinalFluidHu = 9.0F, kNerveHu = 38.0F,
                kEpiduralVeinHu = 95.0F;

/// The sac with the spinal fluid: lies in the front of the canal between the laminae.
CanalSection sac_section(const SpineData& spine, float s_mm) {
  CanalSection section = canal_section(spine, s_mm);
  const float behind = mix(kFatLeastMm, kFatBehindMm, between_laminae(spine, s_mm));
  section.y -= 0.5F * (behind - kFatInFrontMm);
  section.radius_y = std::max(section.radius_y - 0.5F * (behind + kFatInFrontMm), 1.0F);
  section.radius_x = std::max(section.radius_x - 1.6F, 1.0F);
  return section;
}

float sac(const SpineData& spine, const Vec3f& u) {
  const CanalSection section = sac_section(spine, u.z());
  const float wall = elliptic_cylinder(u.x(), u.y() - section.y, section.radius_x, section.radius_y);
  return smooth_max(wall, kSacEnd - u.z(), 6.0F);
}

/// Cord and conus: ends at L1.
float cord(const SpineData& spine, const Vec3f& u) {
  const CanalSection section = sac_section(spine, u.z());
  const float rest = spine.cord_end_z.share(u.z());
  if (rest <= 0.0F) return Tube::kReach;
  return elliptic_cylinder(u.x(), u.y() - section.y, std::max(spine.cord_radii_mm[1] * rest, 0.5F),
                           std::max(spine.cord_radii_mm[0] * rest, 0.5F) + 0.6F);
}

/// Roots of the cauda equina. Lying on the back they sink to the back and sides of the sac; they leave the midline
/// free.
Tube cauda_equina(const SpineData& spine) {
  std::vector<Cone> cones;
  constexpr float kFrom = -2.0F, kStepMm = 8.0F;
  constexpr int kRoots = 5;
  for (const float sign : {-1.0F, 1.0F})
    for (int root = 0; root < kRoots; ++root) {
      const auto number = static_cast<float>(root);
      const float end = kSacEnd + 12.0F + 26.0F * (kRoots - 1 - number) * 0.9F;  // outer roots leave first
      const auto at = [&](float s) -> Vec3f {
        const CanalSection section = sac_section(spine, s);
        const float out = 0.34F + 0.13F * number;
        const float angle = 0.75F - 0.28F * number;
        const float share = smooth_step(kFrom + 6.0F, kFrom - 40.0F, s);
        return {sign * mix(1.4F, out * section.radius_x, share),
                section.y + mix(0.0F, std::sin(angle) * 0.62F * section.radius_y, share), s};
      };
      for (float s = kFrom; s > end; s -= kStepMm) cones.push_back({at(s), at(s - kStepMm), 0.75F, 0.75F});
    }
  return Tube(std::move(cones));
}

Box canal_box(float half_width) {
  Box box = whole_box();
  box.low.x() = -half_width - 30.0F;
  box.high.x() = half_width + 30.0F;
  box.low.y() = 0.0F;
  box.high.z() = kTopMm;
  return box;
}

/// How far the tips of the spinous processes, and below them the crest of the sacrum, lie behind the middle line.
float process_tip(float s_mm) {
  constexpr float kLumbar = 60.5F, kFirstSacral = 40.0F, kLastSacral = 22.0F;
  const float upper = mix(kLumbar, kFirstSacral, smooth_step(-142.0F, -166.0F, s_mm));
  return mix(upper, kLastSacral, smooth_step(-170.0F, -240.0F, s_mm));
}

void add_ligaments(Anatomy& anatomy) {
  const SpineData& spine = anatomy.data.spine;
  const auto between_processes = [&spine](const Vec3f& u) {
    const float tip = process_tip(u.z());
    const float from = canal_section(spine, u.z()).y + canal_section(spine, u.z()).radius_y + 1.0F;
    return std::max({std::abs(u.x()) - 2.6F, from - u.y(), u.y() - tip + 3.0F, -166.0F - u.z()});
  };
  anatomy.add_plain(
      "interspinous_ligament", canal_box(3.0F), [=](const Place& place) { return between_processes(place.spine); },
      kLigamentHu, 22.0F, 5.0F);
  // Behind the tips of the spinous processes there is no muscle, only fat between the two halves of the back.
  anatomy.add_plain(
      "fat", canal_box(18.0F),
      [](const Place& place) {
        const Vec3f& u = place.spine;
        const float tip = process_tip(u.z());
        const float width = 7.0F + 0.45F * std::max(u.y() - tip, 0.0F);
        const float wedge = smooth_max(0.85F * (std::abs(u.x()) - width), tip - 1.0F - u.y(), 3.0F);
        return std::max(wedge, place.skin + 2.5F);
      },
      kSpinalFatHu - 6.0F, 10.0F, 6.0F);
  anatomy.add_plain(
      "supraspinous_ligament", canal_box(4.0F),
      [](const Place& place) {
        const Vec3f& u = place.spine;
        return std::max(elliptic_cylinder(u.x(), u.y() - process_tip(u.z()) + 0.5F, 3.6F, 3.2F), -166.0F - u.z());
      },
      kLigamentHu + 10.0F, 6.0F, 6.0F);
  anatomy.add_plain(
      "ligamentum_flavum", canal_box(kFlavumHalfWidth),
      [&spine](const Place& place) {
        const Vec3f& u = place.spine;
        const float wall = canal(spine, u);
        const float in_front = canal_section(spine, u.z()).y + 0.5F - u.y();
        return std::max({wall - kFlavumMm, -wall, in_front, std::abs(u.x()) - kFlavumHalfWidth, -152.0F - u.z()});
      },
      kFlavumHu, 6.0F, 5.0F);
}

void add_canal_content(Anatomy& anatomy) {
  const SpineData& spine = anatomy.data.spine;
  anatomy.add_plain(
      "epidural_fat", canal_box(18.0F), [&spine](const Place& place) { return canal(spine, place.spine); },
      kSpinalFatHu, 12.0F, 4.0F);
  const std::uint8_t fluid = anatomy.label("dural_sac");
  const std::uint8_t nerve = anatomy.label("spinal_cord");
  const std::uint8_t roots = anatomy.label("cauda_equina");
  const Tube cauda = cauda_equina(spine);
  anatomy.add({"dural_sac", canal_box(14.0F), [&spine](const Place& place) { return sac(spine, place.spine); },
               [=, &spine](const Place& place, float distance, const Brush& brush) {
                 const Vec3f& u = place.spine;
                 const float of_cord = cord(spine, u), of_roots = cauda.distance(u);
                 const float dura = brush.cover(std::abs(distance + kDuraMm) - kDuraMm);
                 float hu = mix(kSpinalFluidHu, 45.0F, dura);
                 hu = mix(hu, kNerveHu, std::max(brush.cover(of_cord), brush.cover(of_roots)));
                 if (of_cord < 0.0F) return Paint{hu, nerve};
                 return Paint{hu, of_roots < 0.0F ? roots : fluid};
               }});
}

}  // namespace

void add_epidural_veins(Anatomy& anatomy) {
  const SpineData& spine = anatomy.data.spine;
  anatomy.add_plain(
      "epidural_veins", canal_box(14.0F),
      [&spine](const Place& place) {
        const Vec3f& u = place.spine;
        const CanalSection section = sac_section(spine, u.z());
        const float behind = u.y() - section.y + kVeinsFrontShare * section.radius_y;
        return std::max({canal(spine, u), -sac(spine, u), behind});
      },
      kEpiduralVeinHu, 8.0F, 4.0F);
}

void add_spinal_canal(Anatomy& anatomy) {
  add_ligaments(anatomy);
  add_canal_content(anatomy);
}

}  // namespace trocar::phantom
