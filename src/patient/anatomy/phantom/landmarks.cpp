#include "anatomy/phantom/landmarks.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>

#include "anatomy/phantom/bone.h"
#include "anatomy/phantom/expert_paths.h"
#include "anatomy/phantom/path_search.h"

namespace trocar::anatomy::phantom {
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
  std::vector<Landmark> take() { return std::move(landmarks_); }

 private:
  const Anatomy& anatomy_;
  std::vector<Landmark> landmarks_;
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

std::vector<Landmark> find_landmarks(const Anatomy& anatomy) {
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

}  // namespace trocar::anatomy::phantom
