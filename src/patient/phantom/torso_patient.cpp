#include "phantom/torso_patient.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/parallel.h"
#include "phantom/biopsy.h"
#include "phantom/expert_paths.h"
#include "phantom/liver.h"
#include "phantom/skeleton.h"
#include "phantom/structure.h"

namespace trocar::phantom {

/// Free fluid in the abdomen: fills the lowest space of the peritoneal cavity for the patient's posture, and surrounds
/// the bowel on its mesentery, which floats up.
class FreeFluid {
 public:
  /// Adds the fluid before the organs, which cover it. Nothing if the body has no ascites.
  explicit FreeFluid(Anatomy& anatomy);
  /// Call when all organs are there: sets the level at which the space below it holds the wanted volume. Returns the
  /// volume, which is less if the cavity cannot hold it (ml, in the patient's size).
  double settle(Anatomy& anatomy);

 private:
  struct Level {
    float below_mm = 0.0F;  ///< Along gravity; fluid lies where a point is farther along gravity.
  };
  std::shared_ptr<Level> level_;
  std::size_t index_ = 0;  ///< Of the fluid among the structures.
};

namespace {

constexpr float kLongestBiopsyMm = 132.0F;  ///< In the patient's size; the task allows 140.

/// Lesions and the way to the first, where the case is a biopsy; otherwise none, and a path that is in nobody's way.
Result<BiopsyPlan> lesions_of(Anatomy& anatomy, const CaseDescription& description) {
  if (description.task == "liver-biopsy") {
    anatomy.data.lesions.longest_path_mm = kLongestBiopsyMm / anatomy.scale();
    // A lesion that finds no room with a safe way to it is made smaller.
    for (const double share : {1.0, 0.8, 0.6}) {
      anatomy.body.lesion_diameter_mm = share * description.body.lesion_diameter_mm;
      auto plan = plan_biopsy(anatomy);
      if (plan || share == 0.6) return plan;
    }
  }
  BiopsyPlan none;
  none.path.line_P = {Vec3::Constant(1e5), Vec3::Constant(1e5 + 1.0)};
  return none;
}

/// Sizes and segments of all lesions, by the numbers of their labels: "lesions of the liver: 1 of 21 mm in segment VI,
/// …".
std::string finding_of(const Anatomy& anatomy, const std::vector<Lesion>& lesions) {
  std::string text = lesions.size() == 1 ? "lesion of the liver: " : "lesions of the liver: ";
  for (std::size_t n = 0; n < lesions.size(); ++n)
    text += fmt::format("{}{} of {:.0f} mm in segment {}", n == 0 ? "" : ", ", n + 1,
                        2.0F * lesions[n].radius_mm * anatomy.scale(),
                        liver_segment(anatomy, anatomy.torso.at(lesions[n].centre)));
  return text;
}

}  // namespace

Result<TorsoPlan> build_torso(Anatomy& anatomy, const CaseDescription& description) {
  add_trunk(anatomy);
  add_thorax(anatomy);
  FreeFluid fluid(anatomy);
  add_bowel(anatomy);
  add_stomach(anatomy);
  add_spleen(anatomy);
  add_pancreas(anatomy);
  add_pelvic_organs(anatomy);
  add_back_muscles(anatomy);
  add_kidneys(anatomy);
  add_liver(anatomy);
  add_great_vessels(anatomy);
  add_skeleton(anatomy);
  TROCAR_TRY(const BiopsyPlan biopsy, lesions_of(anatomy, description));
  const DuctTree ducts = add_liver_vessels(anatomy, biopsy);
  add_lesions(anatomy, biopsy);
  add_epidural_veins(anatomy);
  TROCAR_TRY_STATUS(anatomy.check_labels());
  fluid.settle(anatomy);
  TorsoPlan plan;
  plan.landmarks = find_landmarks(anatomy);
  if (description.task == "liver-biopsy") {
    plan.paths = {biopsy.path};
    plan.paths.front().name = "liver-biopsy: lesion 1";  // the one that the case describes
    plan.finding = finding_of(anatomy, biopsy.lesions);
    for (Vec3* end : {&plan.paths.front().line_P.a, &plan.paths.front().line_P.b}) *end *= anatomy.scale();
  } else if (description.task == "lumbar-puncture") {
    TROCAR_TRY(plan.paths, plan_lumbar_paths(anatomy));
  } else if (description.task == "ascites-puncture") {
    TROCAR_TRY(plan.paths, plan_ascites_paths(anatomy));
  } else if (description.task == "ptcd") {
    TROCAR_TRY(plan.paths, plan_bile_duct_paths(anatomy, ducts));
  }
  return plan;
}

namespace {

constexpr float kFront = kPi;

class Landmarks {
 public:
  explicit Landmarks(const Anatomy& anatomy) : anatomy_(anatomy) {}

  void add(std::string name, const Vec3f& p) {
    const Box& box = anatomy_.torso.box();
    if (p.z() > box.low.z() && p.z() < box.high.z())
      landmarks_.push_back({std::move(name), static_cast<double>(anatomy_.scale()) * p.cast<double>()});
  }
  /// A point of the skin, by its angle from the back's midline (negative to the right) and its height.
  void add_on_skin(std::string name, float phi, float z) {
    const float r = anatomy_.torso.contours().skin_radius(phi, z);
    add(std::move(name), Vec3f(r * std::sin(phi), r * std::cos(phi), z));
  }
  /// Skin over the tip of a spinous process.
  void add_spinous_process(const std::string& vertebra, int level) {
    const bool lumbar = level > kT12;
    const VertebraData& data = lumbar ? anatomy_.data.lumbar_vertebra : anatomy_.data.thoracic_vertebra;
    const Cone& upper = data.spinous.front();
    const Cone& lower = data.spinous.back();
    const float s = anatomy_.data.spine.height(level) + 0.25F * (upper.a.z() + upper.b.z() + lower.a.z() + lower.b.z());
    const SpineCurve& spine = anatomy_.torso.spine();
    const Vec3f tip = spine.bend(Vec3f(0.0F, upper.b.y(), s));
    add("spinous process " + vertebra, leave_body(anatomy_, tip, spine.direction(Vec3f::UnitY(), s).normalized()));
  }
  std::vector<anatomy::Landmark> take() { return std::move(landmarks_); }

 private:
  const Anatomy& anatomy_;
  std::vector<anatomy::Landmark> landmarks_;
};

void add_pelvic_landmarks(Landmarks& landmarks, const Anatomy& anatomy) {
  constexpr float kCrestAngle = 80.0F * kDegree, kCrestHeight = -101.0F;
  constexpr float kBackAngle = 36.0F * kDegree, kBackHeight = -160.0F;
  constexpr float kSymphysisHeight = -246.0F;
  for (const float sign : {-1.0F, 1.0F}) {
    const std::string side = sign < 0.0F ? "right " : "left ";
    landmarks.add(side + "anterior superior iliac spine", iliac_spine_on_skin(anatomy, sign));
    landmarks.add_on_skin(side + "iliac crest", sign * kCrestAngle, kCrestHeight);
    landmarks.add_on_skin(side + "posterior superior iliac spine", sign * kBackAngle, kBackHeight);
  }
  landmarks.add_on_skin("pubic symphysis", kFront, kSymphysisHeight);
}

}  // namespace

std::vector<anatomy::Landmark> find_landmarks(const Anatomy& anatomy) {
  const LandmarkData& data = anatomy.data.landmarks;
  constexpr int kT10 = 5;
  Landmarks landmarks(anatomy);
  landmarks.add_on_skin("xiphoid", kFront, data.xiphoid_z_mm);
  landmarks.add_on_skin("umbilicus", kFront, anatomy.data.torso.umbilicus_z_mm);
  landmarks.add_spinous_process("T12", kT12);
  for (int level = kL1; level <= kL5; ++level) landmarks.add_spinous_process(fmt::format("L{}", level - kT12), level);
  landmarks.add(kHilumLandmark, anatomy.unwarped(anatomy.data.liver.hilum));
  landmarks.add_on_skin("right mid-axillary line, tenth rib", -0.5F * kFront,
                        anatomy.data.spine.height(kT10) - data.tenth_rib_below_t10_mm);
  add_pelvic_landmarks(landmarks, anatomy);
  return landmarks.take();
}

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
  const Vec3f down = anatomy::gravity_P(anatomy.posture).cast<float>();
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
  const Vec3f down = anatomy::gravity_P(anatomy.posture).cast<float>();
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
  return -anatomy::gravity_P(anatomy.posture).cast<float>();
}

}  // namespace trocar::phantom
