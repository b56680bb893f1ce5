#include "phantom/expert_paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "phantom/skeleton.h"

namespace trocar::phantom {
namespace {

anatomy::NeedlePath path_of(const Anatomy& anatomy, std::string name, const Vec3f& entry, const Vec3f& target) {
  const auto scale = static_cast<double>(anatomy.scale());
  return {std::move(name), {scale * entry.cast<double>(), scale * target.cast<double>()}};
}

/// The places of a straight line, each half millimetre, from `entry` to `beyond_mm` behind the target.
template <class Visit>
bool all_along(const Anatomy& anatomy, const Vec3f& entry, const Vec3f& target, float beyond_mm, const Visit& visit) {
  constexpr float kStepMm = 0.5F;
  const float length = (target - entry).norm();
  const Vec3f direction = (target - entry) / length;
  for (float along = 0.0F; along < length + beyond_mm; along += kStepMm)
    if (!visit(anatomy.torso.at(entry + along * direction), length - along)) return false;
  return true;
}

/// Outward normal of the skin.
Vec3f skin_normal(const Anatomy& anatomy, const Vec3f& p) {
  constexpr float kStepMm = 1.5F;
  const auto skin = [&](const Vec3f& at) { return anatomy.torso.at(at).skin; };
  Vec3f slope;
  for (int a = 0; a < 3; ++a) {
    const Vec3f step = kStepMm * Vec3f::Unit(a);
    slope[a] = skin(p + step) - skin(p - step);
  }
  return slope.normalized();
}

// Lumbar puncture.

constexpr float kNeedleClearanceMm = 1.2F;  ///< Axis of the needle to bone: a 22 G needle and a reserve of 0.8 mm.
constexpr float kMostClearanceMm = 6.0F;

struct Interspace {
  Vec3f entry, target;
  float clearance = 0.0F;
};

/// The best line in the midline through the space below a vertebra: the one farthest from bone.
Interspace best_line(const Anatomy& anatomy, const Obstacles& bones, int above) {
  const SpineCurve& spine = anatomy.torso.spine();
  const float disc = disc_position(anatomy.data.spine, above);
  Interspace best;
  for (float s = disc - 14.0F; s <= disc + 6.0F; s += 1.0F) {
    const CanalSection canal = canal_section(anatomy.data.spine, s);
    const Vec3f target = spine.bend(Vec3f(0.0F, canal.y - 0.5F, s));
    for (float cranial_deg = -8.0F; cranial_deg <= 24.0F; cranial_deg += 2.0F) {
      const float angle = cranial_deg * kDegree;
      const Vec3f outwards = spine.direction(Vec3f(0.0F, std::cos(angle), -std::sin(angle)), s).normalized();
      const Vec3f entry = leave_body(anatomy, target, outwards);
      float clearance = best.clearance;  // a better line has more everywhere
      const auto is_free = [&](float mm) {
        return all_along(anatomy, entry, target, 2.0F,
                         [&](const Place& place, float) { return bones.all_farther(place, mm); });
      };
      if (!is_free(clearance + 0.25F)) continue;
      while (clearance < kMostClearanceMm && is_free(clearance + 0.25F)) clearance += 0.25F;
      best = {entry, target, clearance};
    }
  }
  return best;
}

// Ascites puncture.

constexpr float kInwardMm = 10.0F;       ///< The tip in the fluid, behind the peritoneum.
constexpr float kUsualNeedleMm = 68.0F;  ///< Reach of the usual needle; a thick wall takes a longer one.
constexpr float kBowelClearanceMm = 8.0F, kLeastBowelClearanceMm = 5.0F, kEpigastricClearanceMm = 10.0F;
constexpr float kFluidBeyondMm = 6.0F;

struct FluidRisks {
  explicit FluidRisks(const Anatomy& anatomy)
      : bones(bones_of(anatomy)), bowel(anatomy, kBowel), vessels(anatomy, kVessels) {}
  static constexpr std::array<std::string_view, 8> kBowel{"small_bowel", "colon",  "stomach",         "duodenum",
                                                          "liver",       "spleen", "urinary_bladder", "kidney"};
  static constexpr std::array<std::string_view, 4> kVessels{"epigastric_vessels", "aorta", "inferior_vena_cava",
                                                            "portal_vein"};
  Obstacles bones, bowel, vessels;
};

/// A path straight into the skin at an entry, if fluid lies behind the wall and all risks keep their distance.
std::optional<Vec3f> fluid_target(const Anatomy& anatomy, const FluidRisks& risks, const Vec3f& entry,
                                  float from_bowel_mm) {
  constexpr float kStepMm = 0.5F, kDeepest = 110.0F;
  const Vec3f outward = skin_normal(anatomy, entry);
  const auto* fluid = anatomy.label_table.find("ascites");
  if (fluid == nullptr) return std::nullopt;
  float fluid_begin = -1.0F;
  for (float depth = 1.0F; depth < kDeepest; depth += kStepMm) {
    const Place place = anatomy.torso.at(entry - depth * outward);
    if (!risks.bones.all_farther(place, 4.0F) || !risks.bowel.all_farther(place, from_bowel_mm) ||
        !risks.vessels.all_farther(place, kEpigastricClearanceMm))
      return std::nullopt;
    const bool in_fluid = anatomy.label_at(place) == fluid->id;
    if (in_fluid && fluid_begin < 0.0F) fluid_begin = depth;
    if (!in_fluid && fluid_begin >= 0.0F) return std::nullopt;
    if (fluid_begin >= 0.0F && depth >= fluid_begin + kInwardMm + kFluidBeyondMm)
      return entry - (fluid_begin + kInwardMm) * outward;
  }
  return std::nullopt;
}

/// On the skin: `medial` and `cranial` mm from the iliac spine.
Vec3f beside_iliac_spine(const Anatomy& anatomy, float sign, float medial_mm, float cranial_mm) {
  const Vec3f spine = iliac_spine_on_skin(anatomy, sign);
  const float z = spine.z() + cranial_mm;
  const float phi = std::atan2(std::abs(spine.x()), spine.y()) + medial_mm / std::hypot(spine.x(), spine.y());
  const float r = anatomy.torso.contours().skin_radius(sign * phi, z);
  return {r * std::sin(sign * phi), r * std::cos(phi), z};
}

/// The first place that the usual needle reaches, else the first place.
std::optional<anatomy::NeedlePath> ascites_path(const Anatomy& anatomy, const FluidRisks& risks, float sign,
                                                const std::vector<std::array<float, 3>>& offsets, float from_bowel_mm) {
  const std::string name =
      sign > 0.0F ? "ascites-puncture: left lower quadrant" : "ascites-puncture: right lower quadrant";
  std::optional<anatomy::NeedlePath> first;
  for (const auto& [off, medial, cranial] : offsets) {
    const Vec3f entry = beside_iliac_spine(anatomy, sign, medial, cranial);
    const auto target = fluid_target(anatomy, risks, entry, from_bowel_mm);
    if (!target) continue;
    anatomy::NeedlePath path = path_of(anatomy, name, entry, *target);
    if (path.line_P.length_mm() < kUsualNeedleMm) return path;
    if (!first) first = std::move(path);
  }
  return first;
}

// Bile duct puncture.

constexpr float kDuctMarginMm = 1.2F;  ///< Of the needle's axis from vessels.
constexpr float kOrganMarginMm = 6.0F, kBoneMarginMm = 4.0F;
constexpr float kLongestMm = 135.0F, kFromHilumMm = 28.0F;
constexpr float kMostPosterior = 0.42F;  ///< The skin may face backwards by 25 degrees.
constexpr float kLeastDuctMm = 1.1F;

struct LiverRisks {
  explicit LiverRisks(const Anatomy& anatomy)
      : bones(bones_of(anatomy)),
        organs(anatomy, kOrgans),
        vessels(anatomy, kVessels),
        lesions(anatomy, kLesions),
        liver(anatomy.find("liver")) {}
  static constexpr std::array<std::string_view, 8> kOrgans{"lung",        "gallbladder", "kidney_right", "colon",
                                                           "small_bowel", "duodenum",    "stomach",      "aorta"};
  static constexpr std::array<std::string_view, 4> kVessels{"portal_vein", "hepatic_veins", "inferior_vena_cava",
                                                            "hepatic_artery"};
  static constexpr std::array<std::string_view, 2> kLesions{"liver_lesion", "tumor"};
  Obstacles bones, organs, vessels, lesions;
  const Structure& liver;
};

bool is_safe(const Anatomy& anatomy, const LiverRisks& risks, const Vec3f& entry, const Vec3f& target) {
  if ((target - entry).norm() * anatomy.scale() > kLongestMm) return false;
  bool was_in_liver = false;
  return all_along(anatomy, entry, target, 1.0F, [&](const Place& place, float) {
    const bool in_liver = risks.liver.distance(place) < 0.0F;
    if (was_in_liver && !in_liver) return false;
    was_in_liver = in_liver;
    return risks.bones.all_farther(place, kBoneMarginMm) && risks.organs.all_farther(place, kOrganMarginMm) &&
           risks.vessels.all_farther(place, kDuctMarginMm) && risks.lesions.all_farther(place, 2.0F);
  });
}

std::optional<anatomy::NeedlePath> find_duct_path(const Anatomy& anatomy, const LiverRisks& risks, const Tube& ducts,
                                                  Random& random, const std::string& name) {
  constexpr int kTries = 12000;
  const LesionData& gates = anatomy.data.lesions;
  const Vec3f hilum = anatomy.unwarped(anatomy.data.liver.hilum);
  for (int n = 0; n < kTries; ++n) {
    const auto pick = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(ducts.cones().size())));
    const Cone& duct = ducts.cones()[std::min(pick, ducts.cones().size() - 1)];
    const Vec3f target = 0.5F * (duct.a + duct.b);
    if (duct.radius_a < kLeastDuctMm || (target - hilum).norm() < kFromHilumMm) continue;
    const float side = gates.gate_deg.draw(random) * kDegree;
    const Vec3f gate = anatomy.torso.contours().on_cavity(-side, gates.gate_z_mm.draw(random), gates.gate_outward_mm);
    if (!intercostal_space(anatomy.data, anatomy.torso.at(gate))) continue;
    const Vec3f outwards = (gate - target).normalized();
    const Vec3f along = (duct.b - duct.a).normalized();
    constexpr float kMostParallel = 0.9F;  // a needle along the duct would miss it
    if (std::abs(outwards.dot(along)) > kMostParallel) continue;
    const Vec3f entry = leave_body(anatomy, gate, outwards);
    if (skin_normal(anatomy, entry).y() > kMostPosterior) continue;
    if (is_safe(anatomy, risks, entry, target)) return path_of(anatomy, name, entry, target);
  }
  return std::nullopt;
}

}  // namespace

Vec3f iliac_spine_on_skin(const Anatomy& anatomy, float sign) {
  constexpr float kAngle = 111.0F * kDegree, kHeight = -148.0F;
  const float r = anatomy.torso.contours().skin_radius(sign * kAngle, kHeight);
  return {sign * r * std::sin(kAngle), r * std::cos(kAngle), kHeight};
}

Result<std::vector<anatomy::NeedlePath>> plan_lumbar_paths(const Anatomy& anatomy) {
  constexpr std::array<std::string_view, 2> kBones{"vertebrae", "sacrum"};
  const Obstacles bones(anatomy, kBones);
  std::vector<std::pair<float, anatomy::NeedlePath>> found;
  for (const int above : {kL3, kL3 + 1, kL5}) {
    const Interspace space = best_line(anatomy, bones, above);
    if (space.clearance < kNeedleClearanceMm) continue;
    const int number = above - kT12;
    const std::string name = above == kL5 ? "lumbar-puncture: midline L5/S1"
                                          : fmt::format("lumbar-puncture: midline L{}/L{}", number, number + 1);
    found.emplace_back(space.clearance, path_of(anatomy, name, space.entry, space.target));
  }
  if (found.empty())
    return fail("no needle fits between the spinous processes of this body", "phantom", "choose another seed");
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<anatomy::NeedlePath> paths;
  for (auto& [clearance, path] : found) paths.push_back(std::move(path));
  return paths;
}

Result<std::vector<anatomy::NeedlePath>> plan_ascites_paths(const Anatomy& anatomy) {
  const FluidRisks risks(anatomy);
  std::vector<anatomy::NeedlePath> paths;
  // Nearest to the usual point first: 3 cm medial and 3 cm cranial of the iliac spine.
  constexpr float kUsualMm = 30.0F;
  std::vector<std::array<float, 3>> offsets;
  for (float medial = 5.0F; medial <= 62.0F; medial += 4.0F)
    for (float cranial = -10.0F; cranial <= 70.0F; cranial += 5.0F)
      offsets.push_back({std::hypot(medial - kUsualMm, cranial - kUsualMm), medial, cranial});
  std::sort(offsets.begin(), offsets.end());
  for (const float from_bowel_mm : {kBowelClearanceMm, kLeastBowelClearanceMm})
    for (const float sign : {1.0F, -1.0F})
      if (paths.empty() || from_bowel_mm == kBowelClearanceMm)
        if (auto path = ascites_path(anatomy, risks, sign, offsets, from_bowel_mm)) paths.push_back(*std::move(path));
  if (paths.empty())
    return fail("no safe way to the free fluid of this body", "phantom", "choose another seed or more ascites");
  return paths;
}

Result<std::vector<anatomy::NeedlePath>> plan_bile_duct_paths(const Anatomy& anatomy, const DuctTree& ducts) {
  const LiverRisks risks(anatomy);
  Random random = anatomy.random("bile duct paths");
  std::vector<anatomy::NeedlePath> paths;
  constexpr int kPaths = 3;
  for (int n = 1; n <= kPaths && !ducts.inside.empty(); ++n)
    if (auto path = find_duct_path(anatomy, risks, ducts.inside, random, fmt::format("ptcd: right flank {}", n)))
      paths.push_back(*std::move(path));
  if (paths.empty())
    return fail("no safe way to a bile duct of this body", "phantom", "choose another seed or wider ducts");
  return paths;
}

Obstacles::Obstacles(const Anatomy& anatomy, std::span<const std::string_view> prefixes) {
  for (const Structure& s : anatomy.structures)
    if (std::any_of(prefixes.begin(), prefixes.end(), [&](std::string_view p) { return s.name.starts_with(p); }))
      structures_.push_back(&s);
}

bool Obstacles::all_farther(const Place& place, float mm) const {
  const Box reach = Box::around(place.p, Vec3f::Constant(mm));
  return std::all_of(structures_.begin(), structures_.end(),
                     [&](const Structure* s) { return !s->bounds.overlaps(reach) || s->distance(place) > mm; });
}

Obstacles bones_of(const Anatomy& anatomy) {
  static constexpr std::array<std::string_view, 7> kBones{"rib_", "vertebrae", "costal_cartilages", "sternum", "sacrum",
                                                          "hip_", "femur_"};
  return {anatomy, kBones};
}

Vec3f leave_body(const Anatomy& anatomy, const Vec3f& inside, const Vec3f& direction) {
  constexpr float kFarthest = 330.0F;
  float low = 0.0F;
  float high = kFarthest;
  for (int n = 0; n < 40; ++n) {
    const float middle = 0.5F * (low + high);
    (anatomy.torso.at(inside + middle * direction).skin < 0.0F ? low : high) = middle;
  }
  return inside + low * direction;
}

}  // namespace trocar::phantom
