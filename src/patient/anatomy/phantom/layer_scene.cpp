#include "anatomy/phantom/layer_scene.h"

#include <algorithm>
#include <cmath>

#include "anatomy/phantom/layers.h"

namespace trocar::anatomy::phantom {
namespace {

// Hounsfield units of the portal venous phase, typical values [assumed].
constexpr float kSkinHu = 20.0F;
constexpr float kFatHu = -105.0F;
constexpr float kMuscleHu = 55.0F;
constexpr float kLigamentHu = 75.0F;
constexpr float kFlavumHu = 85.0F;
constexpr float kCsfHu = 8.0F;
constexpr float kAscitesHu = 8.0F;
constexpr float kDiscHu = 85.0F;
constexpr float kCorticalHu = 900.0F;
constexpr float kCancellousHu = 220.0F;
constexpr float kLiverHu = 105.0F;
constexpr float kBileHu = 10.0F;
constexpr float kPortalHu = 170.0F;
constexpr float kBowelWallHu = 45.0F;
constexpr float kBowelContentHu = 20.0F;
constexpr float kGasHu = -850.0F;

constexpr float kSkinMm = 2.0F;
constexpr float kCortexMm = 1.4F;
constexpr float kEnd = 1000.0F;  ///< Outside the block.

float slab(float depth, float from, float to) {
  return std::max(from - depth, depth - to);
}

/// Adds a bone as a shell of cortex around spongy bone.
template <class Distance>
void add_bone(LayerScene& scene, std::string_view name, Distance distance) {
  scene.shapes.push_back({name, kCorticalHu, 0.0F, distance});
  scene.shapes.push_back(
      {name, kCancellousHu, 30.0F, [distance](float x, float d, float z) { return distance(x, d, z) + kCortexMm; }});
}

/// Fat everywhere, skin in front.
void add_cover(LayerScene& scene) {
  scene.shapes.push_back({"fat", kFatHu, 8.0F, [](float, float d, float) { return slab(d, 0.0F, kEnd); }});
  scene.shapes.push_back({"fat", kSkinHu, 0.0F, [](float, float d, float) { return slab(d, 0.0F, kSkinMm); }});
}

// The lumbar block is between two vertebrae: the interspace is at z = 0.
constexpr float kSpinousHalfWidth = 3.5F;
constexpr float kGapHalf = 7.0F;      ///< Half the height between two spinous processes.
constexpr float kSpinousTop = 27.0F;  ///< Upper end of the upper process, above the interspace.
constexpr float kDiscHalf = 5.0F;
constexpr float kCanalEnd = 74.0F;

float body(float x, float d) {
  return elliptic_cylinder(x, d - 91.0F, 24.0F, 17.0F);
}
/// The canal, enlarged by a wall.
float canal(float x, float d, float wall) {
  const float half = 0.5F * (kCanalEnd - lumbar::kEpidural);
  return elliptic_cylinder(x, d - lumbar::kEpidural - half, 12.0F + wall, half + wall);
}
/// The upper vertebra; the lower one is its mirror image.
float vertebra(float x, float d, float z) {
  const float side = std::abs(x);
  const float corpus = std::max(body(x, d), kDiscHalf - z);
  const float lamina = std::max({canal(x, d, 7.0F), -canal(x, d, 0.0F), d - 64.0F, kGapHalf - z, z - 30.0F});
  const float spinous =
      std::max({side - kSpinousHalfWidth, lumbar::kInterspinous - d, d - 47.0F, kGapHalf - z, z - kSpinousTop});
  const float pedicle = std::max({std::abs(side - 16.0F) - 4.5F, slab(d, 58.0F, 78.0F), std::abs(z - 19.0F) - 7.0F});
  const float facet = std::max(std::hypot(side - 19.0F, d - 50.0F) - 6.0F, 0.5F - z);
  return std::min({corpus, lamina, spinous, pedicle, facet});
}

void add_back_muscles(LayerScene& scene) {
  for (const bool is_left : {true, false}) {
    const float sign = is_left ? 1.0F : -1.0F;
    scene.shapes.push_back(
        {is_left ? "autochthon_left" : "autochthon_right", kMuscleHu, 7.0F,
         [sign](float x, float d, float) { return std::max(4.0F - sign * x, slab(d, 17.0F, 60.0F)); }});
    scene.shapes.push_back(
        {is_left ? "iliopsoas_left" : "iliopsoas_right", kMuscleHu, 7.0F,
         [sign](float x, float d, float) { return std::max(26.0F - sign * x, slab(d, 74.0F, 112.0F)); }});
  }
}

/// A loop of bowel across the block: wall, content, and gas in front.
void add_loop(LayerScene& scene, float z0, bool has_gas) {
  constexpr float kRadius = 14.0F;
  constexpr float kWall = 2.5F;
  const auto loop = [z0](float d, float z) { return std::hypot(d - ascites::kBowel - kRadius, z - z0) - kRadius; };
  scene.shapes.push_back({"small_bowel", kBowelWallHu, 4.0F, [loop](float, float d, float z) { return loop(d, z); }});
  scene.shapes.push_back(
      {"small_bowel", kBowelContentHu, 12.0F, [loop](float, float d, float z) { return loop(d, z) + kWall; }});
  if (!has_gas) return;
  scene.shapes.push_back({"small_bowel", kGasHu, 0.0F, [loop](float, float d, float z) {
                            return std::max(loop(d, z) + kWall, d - ascites::kBowel - 9.0F);
                          }});
}

}  // namespace

LayerScene lumbar_scene() {
  LayerScene scene;
  scene.is_from_back = true;
  scene.target_mm = lumbar::kDura + 10.0F;  // the dura can be indented by up to 6 mm before its puncture
  scene.path_name = "lumbar puncture";
  add_cover(scene);
  add_back_muscles(scene);
  scene.shapes.push_back({"interspinous_ligament", kLigamentHu, 8.0F, [](float x, float d, float) {
                            return std::max(std::abs(x) - kSpinousHalfWidth,
                                            slab(d, lumbar::kInterspinous, lumbar::kEpidural));
                          }});
  scene.shapes.push_back({"supraspinous_ligament", kLigamentHu, 5.0F, [](float x, float d, float) {
                            return std::max(std::abs(x) - 5.0F, slab(d, lumbar::kSupraspinous, lumbar::kInterspinous));
                          }});
  scene.shapes.push_back({"ligamentum_flavum", kFlavumHu, 4.0F, [](float x, float d, float) {
                            return std::max(canal(x, d, lumbar::kEpidural - lumbar::kFlavum), d - 60.0F);
                          }});
  scene.shapes.push_back({"intervertebral_discs", kDiscHu, 6.0F,
                          [](float x, float d, float z) { return std::max(body(x, d), std::abs(z) - kDiscHalf); }});
  add_bone(scene, "vertebrae_L3", vertebra);
  add_bone(scene, "vertebrae_L4", [](float x, float d, float z) { return vertebra(x, d, -z); });
  scene.shapes.push_back({"epidural_fat", kFatHu, 5.0F, [](float x, float d, float) { return canal(x, d, 0.0F); }});
  scene.shapes.push_back({"csf", kCsfHu, 0.0F, [](float x, float d, float) {
                            const float half = 0.5F * (lumbar::kSacEnd - lumbar::kDura);
                            return elliptic_cylinder(x, d - lumbar::kDura - half, 8.5F, half);
                          }});
  return scene;
}

LayerScene ascites_scene() {
  LayerScene scene;
  scene.target_mm = 0.5F * (ascites::kPeritoneum + ascites::kBowel);
  scene.path_name = "paracentesis";
  add_cover(scene);
  scene.shapes.push_back({"muscle", kMuscleHu, 7.0F,
                          [](float, float d, float) { return slab(d, ascites::kMuscle, ascites::kMuscleEnd); }});
  scene.shapes.push_back({"ascites", kAscitesHu, 0.0F, [](float, float d, float) {
                            return slab(d, ascites::kPeritoneum, ascites::kBowel + 12.0F);
                          }});
  scene.shapes.push_back(
      {"iliopsoas_left", kMuscleHu, 7.0F, [](float, float d, float) { return slab(d, 88.0F, kEnd); }});
  add_loop(scene, 0.0F, false);
  add_loop(scene, 28.5F, true);
  add_loop(scene, -28.5F, true);
  return scene;
}

LayerScene liver_scene() {
  LayerScene scene;
  scene.target_mm = liver::kDuct;
  scene.path_name = "bile duct puncture";
  add_cover(scene);
  scene.shapes.push_back(
      {"muscle", kMuscleHu, 7.0F, [](float, float d, float) { return slab(d, liver::kMuscle, liver::kPeritoneum); }});
  scene.shapes.push_back(
      {"peritoneum", -20.0F, 0.0F, [](float, float d, float) { return slab(d, liver::kPeritoneum, liver::kCapsule); }});
  scene.shapes.push_back(
      {"liver", kLiverHu, 6.0F, [](float, float d, float) { return slab(d, liver::kCapsule, 108.0F); }});
  scene.shapes.push_back({"portal_vein", kPortalHu, 3.0F, [](float, float d, float z) {
                            return std::hypot(d - liver::kVein, z) - liver::kVeinRadius;
                          }});
  scene.shapes.push_back({"bile_duct", kBileHu, 0.0F, [](float, float d, float z) {
                            return std::hypot(d - liver::kDuct, z) - liver::kDuctRadius;
                          }});
  add_bone(scene, "rib_right_9", [](float, float d, float z) { return std::hypot(d - 18.5F, z - 15.0F) - 5.0F; });
  add_bone(scene, "rib_right_10", [](float, float d, float z) { return std::hypot(d - 18.5F, z + 15.0F) - 5.0F; });
  return scene;
}

}  // namespace trocar::anatomy::phantom
