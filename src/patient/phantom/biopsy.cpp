#include "phantom/biopsy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "phantom/expert_paths.h"
#include "phantom/skeleton.h"

namespace trocar::phantom {
namespace {

constexpr int kLesionTries = 60000;
constexpr float kLiverHu = 106.0F;
constexpr std::size_t kLesions = 3;

constexpr std::array<std::string_view, 10> kOrgans{"lung",        "portal_vein_and_splenic_vein",
                                                   "aorta",       "inferior_vena_cava",
                                                   "gallbladder", "kidney_right",
                                                   "colon",       "small_bowel",
                                                   "duodenum",    "stomach"};

/// Structures that a path avoids.
struct Risks {
  Obstacles bones;
  Obstacles organs;
  const Structure* liver;

  explicit Risks(const Anatomy& anatomy)
      : bones(bones_of(anatomy)), organs(anatomy, kOrgans), liver(&anatomy.find("liver")) {}
};

float bone_margin(const PathMargins& m) {
  return static_cast<float>(m.bone_mm + m.reserve_mm);
}
float organ_margin(const PathMargins& m) {
  return static_cast<float>(m.organ_mm + m.reserve_mm);
}

/// True if a lesion can be here: covered by liver, and without a significant vessel.
bool has_room(const Anatomy& anatomy, const Risks& risks, const Lesion& lesion, float cover_mm, float vessel_mm) {
  const Place place = anatomy.torso.at(lesion.centre);
  for (const Vec3f& gate : {anatomy.data.liver.hilum, anatomy.data.liver.venous_confluence})
    if ((lesion.centre - gate).norm() < lesion.radius_mm + anatomy.data.lesions.from_hilum_mm) return false;
  return risks.liver->distance(place) < -(lesion.radius_mm + cover_mm) &&
         risks.organs.all_farther(place, lesion.radius_mm + vessel_mm);
}

/// Checks the path from the skin to the target and slightly beyond.
bool is_safe(const Anatomy& anatomy, const Risks& risks, const Vec3f& entry, const Lesion& lesion,
             const PathMargins& margins) {
  const Vec3f direction = (lesion.centre - entry).normalized();
  const float length = (lesion.centre - entry).norm();
  if (length > anatomy.data.lesions.longest_path_mm) return false;
  float liver_mm = 0.0F;
  constexpr float kStepMm = 0.5F;
  for (float along = 0.0F; along < length + 5.0F; along += kStepMm) {
    const Place place = anatomy.torso.at(entry + along * direction);
    if (!risks.bones.all_farther(place, bone_margin(margins))) return false;
    if (!risks.organs.all_farther(place, organ_margin(margins))) return false;
    const bool in_liver = risks.liver->distance(place) < 0.0F;
    if (in_liver && along < length - lesion.radius_mm - 1.5F) liver_mm += kStepMm;
    if (!in_liver && liver_mm > 0.0F) return false;
  }
  return liver_mm >= margins.liver_mm + margins.reserve_mm;
}

/// Of the body's parameters, varied by the seed.
float lesion_radius(const Anatomy& anatomy, Random& random) {
  const float drawn = anatomy.data.lesions.radius_mm.draw(random);
  if (anatomy.body.lesion_diameter_mm == BodyParameters{}.lesion_diameter_mm) return drawn;
  return static_cast<float>(0.5 * anatomy.body.lesion_diameter_mm) / anatomy.scale();
}

struct Case {
  Lesion lesion;
  Vec3f entry;
};

/// A lesion and a path to it between the ribs of the right flank.
std::optional<Case> find_lesion_with_path(const Anatomy& anatomy, const Risks& risks, const PathMargins& margins,
                                          Random& random) {
  const LesionData& data = anatomy.data.lesions;
  const auto off = [&](std::size_t axis) {
    return static_cast<float>(random.uniform(-data.direction_spread[axis], data.direction_spread[axis]));
  };
  for (int n = 0; n < kLesionTries; ++n) {
    const float side = data.gate_deg.draw(random) * kDegree;
    const Vec3f gate = anatomy.torso.contours().on_cavity(-side, data.gate_z_mm.draw(random), data.gate_outward_mm);
    const Vec3f inward = Vec3f(std::sin(side), -std::cos(side), 0.0F);
    const Vec3f direction = (inward + Vec3f(off(0), off(1), off(2))).normalized();
    const Place at_gate = anatomy.torso.at(gate);
    if (!intercostal_space(anatomy.data, at_gate)) continue;
    if (!risks.bones.all_farther(at_gate, bone_margin(margins))) continue;
    if (!risks.organs.all_farther(at_gate, organ_margin(margins))) continue;
    const Lesion lesion{gate + data.depth_mm.draw(random) * direction, lesion_radius(anatomy, random)};
    if (!has_room(anatomy, risks, lesion, 6.0F, 1.5F)) continue;
    const Vec3f entry = leave_body(anatomy, gate, -direction);
    if (is_safe(anatomy, risks, entry, lesion, margins)) return Case{lesion, entry};
  }
  return std::nullopt;
}

/// A further lesion anywhere in the liver, away from the others.
std::optional<Lesion> find_lesion(const Anatomy& anatomy, const Risks& risks, const std::vector<Lesion>& others,
                                  Random& random) {
  const LesionData& data = anatomy.data.lesions;
  const Box& box = risks.liver->bounds;
  for (int n = 0; n < kLesionTries; ++n) {
    const auto within = [&](int axis) { return static_cast<float>(random.uniform(box.low[axis], box.high[axis])); };
    const float x = within(0);
    const float y = within(1);
    const Lesion lesion{Vec3f(x, y, within(2)), data.other_radius_mm.draw(random)};
    const bool apart = std::all_of(others.begin(), others.end(), [&](const Lesion& other) {
      return (other.centre - lesion.centre).norm() > other.radius_mm + lesion.radius_mm + data.apart_mm;
    });
    if (apart && has_room(anatomy, risks, lesion, 4.0F, 1.0F)) return lesion;
  }
  return std::nullopt;
}

void paint_lesion(Anatomy& anatomy, const Lesion& lesion, int number, Random& random) {
  const auto& noise = anatomy.noise;
  const auto stretch = [&] { return static_cast<float>(random.uniform(0.92, 1.10)); };
  const float a = stretch();
  const float b = stretch();
  const Vec3f radii = lesion.radius_mm * Vec3f(a, b, stretch());
  const std::string name = "liver_lesion_" + std::to_string(number);
  const auto contrast_hu =
      static_cast<float>(number == 1 ? anatomy.body.lesion_contrast_hu : BodyParameters{}.lesion_contrast_hu);
  const float rim_hu = kLiverHu + 0.85F * contrast_hu;
  const std::uint8_t label = anatomy.label(name);
  anatomy.add(
      {name, Box::around(lesion.centre, radii + Vec3f::Constant(3.0F)),
       [=, &noise](const Place& place) {
         return ellipsoid(place.p - lesion.centre, radii) + 1.0F * noise(place.p / 7.0F);
       },
       [=, &noise](const Place& place, float distance, const Brush&) {
         const float core = clamp01(-distance / (0.8F * lesion.radius_mm));
         return Paint{mix(rim_hu, rim_hu - 0.5F * std::abs(contrast_hu), core) + 4.0F * noise(place.p / 5.0F), label};
       }});
}

}  // namespace

bool BiopsyPlan::is_in_the_way(const Vec3f& p, float vessel_radius_mm) const {
  constexpr float kLesionClearanceMm = 1.0F;
  for (const Lesion& lesion : lesions)
    if ((p - lesion.centre).norm() < 1.15F * lesion.radius_mm + vessel_radius_mm + kLesionClearanceMm) return true;
  return distance_mm(path.line_P, p.cast<double>()) < vessel_radius_mm + organ_margin(margins);
}

Result<BiopsyPlan> plan_biopsy(const Anatomy& anatomy, const PathMargins& margins) {
  Random random = anatomy.random("lesions");
  const Risks risks(anatomy);
  const auto first = find_lesion_with_path(anatomy, risks, margins, random);
  if (!first)
    return fail("no safe path to a liver lesion with this seed", "phantom \"abdomen\"", "choose another seed");
  BiopsyPlan plan{margins, {first->lesion}, {"liver-biopsy expert", {}}};
  plan.path.line_P = {first->entry.cast<double>(), first->lesion.centre.cast<double>()};
  while (plan.lesions.size() < kLesions) {
    const auto lesion = find_lesion(anatomy, risks, plan.lesions, random);
    if (!lesion)
      return fail("no space for three liver lesions with this seed", "phantom \"abdomen\"", "choose another seed");
    plan.lesions.push_back(*lesion);
  }
  return plan;
}

void add_lesions(Anatomy& anatomy, const BiopsyPlan& plan) {
  Random random = anatomy.random("lesion shapes");
  int number = 0;
  for (const Lesion& lesion : plan.lesions) paint_lesion(anatomy, lesion, ++number, random);
}

Result<BiopsyPlan> build_abdomen(Anatomy& anatomy) {
  add_trunk(anatomy);
  add_thorax(anatomy);
  add_bowel(anatomy);
  add_stomach(anatomy);
  add_spleen(anatomy);
  add_pancreas(anatomy);
  add_back_muscles(anatomy);
  add_kidneys(anatomy);
  add_liver(anatomy);
  add_great_vessels(anatomy);
  add_skeleton(anatomy);
  TROCAR_TRY(BiopsyPlan plan, plan_biopsy(anatomy));
  add_liver_vessels(anatomy, plan);
  add_lesions(anatomy, plan);
  TROCAR_TRY_STATUS(anatomy.check_labels());
  return plan;
}

}  // namespace trocar::phantom
