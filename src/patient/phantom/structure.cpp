#include "phantom/structure.h"

#include <algorithm>
#include <cmath>

#include "core/result.h"
#include "phantom/skeleton.h"

namespace trocar::phantom {

namespace {

constexpr float kReach = 1000.0F;  ///< Farther than every box, mm.
constexpr float kTorsoTop = 154.0F, kTorsoBottom = -266.0F;
constexpr float kAirMm = 12.0F;  ///< Around the body.

SpineCurve spine_of(const SpineData& spine, const BodyParameters& body) {
  return {Vec3f(0.0F, spine.anchor_y_mm, spine.height(kL3)), spine.inclinations,
          SpineBend{static_cast<float>(body.flexion), static_cast<float>(body.scoliosis_deg) * kDegree}};
}

}  // namespace

Box upper_abdomen_box() {
  return Box::around(Vec3f::Zero(), Vec3f(180.5F, 142.5F, 114.0F));
}

Box torso_box(const AbdomenData& data, const BodyParameters& body, std::uint64_t seed) {
  const TorsoContours contours(mix64(seed), data.torso, body);
  Box box;
  constexpr int kAngles = 120;
  for (float z = kTorsoBottom; z <= kTorsoTop; z += 6.0F)
    for (int n = 0; n < kAngles; ++n) {
      const float phi = kPi * (2.0F * static_cast<float>(n) / kAngles - 1.0F);
      const float r = contours.skin_radius(phi, z);
      box.add(Vec3f(r * std::sin(phi), r * std::cos(phi), z), 0.0F);
    }
  box = box.grown(kAirMm);
  box.low.z() = kTorsoBottom;
  box.high.z() = kTorsoTop;
  return box;
}

Anatomy::Anatomy(std::uint64_t seed_, AbdomenData data_, anatomy::KnownStructures known_, const BodyParameters& body_,
                 const Box& box)
    : data(std::move(data_)),
      known(std::move(known_)),
      body(body_),
      seed(mix64(seed_)),
      torso(seed, data.torso, body, spine_of(data.spine, body), box),
      noise(seed ^ 0x6e6f6973U) {}

std::uint8_t Anatomy::label(std::string_view name) {
  if (const anatomy::Label* present = label_table.find(name)) return present->id;
  const anatomy::KnownStructure* structure = known.find(name);
  if (structure == nullptr) {
    if (unknown_label_.empty()) unknown_label_ = name;
    return 0;
  }
  TROCAR_CHECK(label_table.labels.size() < 255);
  const auto id = static_cast<std::uint8_t>(label_table.labels.size() + 1);
  label_table.labels.push_back({id, std::string(name), structure->tissue, structure->color});
  return id;
}

Status Anatomy::check_labels() const {
  if (unknown_label_.empty()) return {};
  return fail("the phantom's structure \"" + unknown_label_ + "\" is not known", known.file(),
              "add the name to an entry [[structures]]");
}

Random Anatomy::random(std::string_view organ) const {
  std::uint64_t mixed = seed;
  for (const char c : organ) mixed = mix64(mixed ^ static_cast<std::uint64_t>(c));
  return Random(mixed);
}

const Structure& Anatomy::find(std::string_view name) const {
  const auto found = std::find_if(structures.begin(), structures.end(), [&](const auto& s) { return s.name == name; });
  TROCAR_CHECK(found != structures.end());
  return *found;
}

float Anatomy::phase_hu(std::string_view label_name) const {
  if (body.phase == "portal-venous") return 0.0F;
  for (const auto& [prefix, hu] : body.phase == "native" ? data.native : data.arterial)
    if (label_name.starts_with(prefix)) return hu;
  return 0.0F;
}

std::uint8_t Anatomy::label_at(const Place& place) const {
  if (place.skin >= 0.0F) return 0;
  const Box here{place.p, place.p};
  for (auto s = structures.rbegin(); s != structures.rend(); ++s) {
    if (!s->bounds.overlaps(here)) continue;
    if (const float distance = s->distance(place); distance < 0.0F) return s->paint(place, distance, Brush{}).label;
  }
  return 0;
}

Vec3f Anatomy::unwarped(const Vec3f& q) const {
  Vec3f p = q;
  for (int n = 0; n < 20; ++n) p += q - torso.at(p).q;  // the warp's slope is below 1: converges
  return p;
}

void Anatomy::add_plain(std::string name, const Box& bounds, std::function<float(const Place&)> distance, float hu,
                        float texture_hu, float texture_mm) {
  const std::uint8_t id = label(name);
  add({std::move(name), bounds, std::move(distance), [=, this](const Place& place, float, const Brush&) {
         const float texture = texture_hu == 0.0F ? 0.0F : texture_hu * noise.fractal(place.p, texture_mm);
         return Paint{hu + texture, id};
       }});
}

std::string side_of(float sign) {
  return sign < 0.0F ? "_right" : "_left";
}

Vec3f varied(Random& random, const Vec3f& centre, float spread_mm) {
  const auto one = [&](float c) { return c + static_cast<float>(random.uniform(-spread_mm, spread_mm)); };
  const float x = one(centre.x());
  const float y = one(centre.y());
  return {x, y, one(centre.z())};
}

Box whole_box() {
  return Box::around(Vec3f::Zero(), Vec3f::Constant(kReach));
}

Box warped(const Box& box) {
  return box.grown(6.0F);
}

}  // namespace trocar::phantom
