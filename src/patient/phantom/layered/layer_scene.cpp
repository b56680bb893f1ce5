#include "phantom/layered/layer_scene.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "phantom/section_reader.h"

namespace trocar::phantom {
namespace {

// Hounsfield units of the portal venous phase, typical values [assumed].
constexpr float kSkinLayerHu = 20.0F;
constexpr float kFatLayerHu = -105.0F;
constexpr float kMuscleLayerHu = 55.0F;
constexpr float kSpinousLigamentHu = 75.0F;
constexpr float kFlavumLayerHu = 85.0F;
constexpr float kCsfHu = 8.0F;
constexpr float kAscitesHu = 8.0F;
constexpr float kDiscHu = 85.0F;
constexpr float kCorticalHu = 900.0F;
constexpr float kCancellousHu = 220.0F;
constexpr float kPeritoneumHu = -20.0F;
constexpr float kLiverLayerHu = 105.0F;
constexpr float kDuctLumenHu = 10.0F;
constexpr float kPortalBranchHu = 170.0F;
constexpr float kBowelWallHu = 45.0F;
constexpr float kBowelContentHu = 20.0F;
constexpr float kLoopGasHu = -850.0F;

constexpr float kEnd = 1000.0F;  ///< Outside the block.

float slab(float depth, float from, float to) {
  return std::max(from - depth, depth - to);
}

/// Adds a bone as a shell of cortex around spongy bone.
template <class Distance>
void add_bone(LayerScene& scene, const CoverLayers& cover, std::string_view name, Distance distance) {
  scene.shapes.push_back({name, kCorticalHu, 0.0F, distance});
  scene.shapes.push_back(
      {name, kCancellousHu, 30.0F,
       [distance, cortex = cover.bone_cortex](float x, float d, float z) { return distance(x, d, z) + cortex; }});
}

/// Fat everywhere, skin in front.
void add_cover(LayerScene& scene, const CoverLayers& cover) {
  scene.shapes.push_back({"fat", kFatLayerHu, 8.0F, [](float, float d, float) { return slab(d, 0.0F, kEnd); }});
  scene.shapes.push_back(
      {"fat", kSkinLayerHu, 0.0F, [end = cover.skin](float, float d, float) { return slab(d, 0.0F, end); }});
}

/// A slab between two depths.
float slab(float depth, const std::array<float, 2>& ends) {
  return slab(depth, ends[0], ends[1]);
}

float body(const LumbarLayers& l, float x, float d) {
  return elliptic_cylinder(x - l.body.x, d - l.body.y, l.body.radius_x, l.body.radius_y);
}
/// The canal, enlarged by a wall.
float canal(const LumbarLayers& l, float x, float d, float wall) {
  const float half = 0.5F * (l.canal_end - l.epidural);
  return elliptic_cylinder(x, d - l.epidural - half, l.canal_half_width + wall, half + wall);
}
/// The upper vertebra; the lower one is its mirror image.
float vertebra(const LumbarLayers& l, float x, float d, float z) {
  const float side = std::abs(x);
  const float corpus = std::max(body(l, x, d), l.disc_half_height - z);
  const float lamina =
      std::max({canal(l, x, d, l.lamina), -canal(l, x, d, 0.0F), d - l.lamina_end, l.gap_half - z, z - l.lamina_top});
  const float spinous =
      std::max({side - l.spinous_half_width, l.interspinous - d, d - l.spinous_end, l.gap_half - z, z - l.spinous_top});
  const float pedicle = std::max({std::abs(side - l.pedicle_x) - l.pedicle_half_width, slab(d, l.pedicle_depths),
                                  std::abs(z - l.pedicle_z) - l.pedicle_half_height});
  const float facet = std::max(std::hypot(side - l.facet_x, d - l.facet_depth) - l.facet_radius, l.facet_gap_half - z);
  return std::min({corpus, lamina, spinous, pedicle, facet});
}

void add_back_muscles(LayerScene& scene, const LumbarLayers& l) {
  for (const bool is_left : {true, false}) {
    const float sign = is_left ? 1.0F : -1.0F;
    scene.shapes.push_back(
        {is_left ? "autochthon_left" : "autochthon_right", kMuscleLayerHu, 7.0F,
         [=](float x, float d, float) { return std::max(l.erector_x - sign * x, slab(d, l.erector_depths)); }});
    scene.shapes.push_back(
        {is_left ? "iliopsoas_left" : "iliopsoas_right", kMuscleLayerHu, 7.0F,
         [=](float x, float d, float) { return std::max(l.psoas_x - sign * x, slab(d, l.psoas_depths)); }});
  }
}

/// A loop of bowel across the block: wall, content, and gas in front.
void add_loop(LayerScene& scene, const AscitesLayers& l, float z0, bool has_gas) {
  const auto loop = [l, z0](float d, float z) {
    return std::hypot(d - l.bowel - l.loop_radius, z - z0) - l.loop_radius;
  };
  scene.shapes.push_back({"small_bowel", kBowelWallHu, 4.0F, [loop](float, float d, float z) { return loop(d, z); }});
  scene.shapes.push_back(
      {"small_bowel", kBowelContentHu, 12.0F, [loop, l](float, float d, float z) { return loop(d, z) + l.loop_wall; }});
  if (!has_gas) return;
  scene.shapes.push_back({"small_bowel", kLoopGasHu, 0.0F, [loop, l](float, float d, float z) {
                            return std::max(loop(d, z) + l.loop_wall, d - l.bowel - l.gas);
                          }});
}

}  // namespace

LayerScene lumbar_scene(const LayerData& data) {
  const LumbarLayers l = data.lumbar;
  LayerScene scene;
  scene.is_from_back = true;
  scene.target_mm = l.dura + l.target_behind_dura;
  scene.path_name = "lumbar puncture";
  add_cover(scene, data.cover);
  add_back_muscles(scene, l);
  scene.shapes.push_back({"interspinous_ligament", kSpinousLigamentHu, 8.0F, [l](float x, float d, float) {
                            return std::max(std::abs(x) - l.spinous_half_width, slab(d, l.interspinous, l.epidural));
                          }});
  scene.shapes.push_back({"supraspinous_ligament", kSpinousLigamentHu, 5.0F, [l](float x, float d, float) {
                            return std::max(std::abs(x) - l.supraspinous_half_width,
                                            slab(d, l.supraspinous, l.interspinous));
                          }});
  scene.shapes.push_back({"ligamentum_flavum", kFlavumLayerHu, 4.0F, [l](float x, float d, float) {
                            return std::max(canal(l, x, d, l.epidural - l.flavum), d - l.flavum_end);
                          }});
  scene.shapes.push_back({"intervertebral_discs", kDiscHu, 6.0F, [l](float x, float d, float z) {
                            return std::max(body(l, x, d), std::abs(z) - l.disc_half_height);
                          }});
  add_bone(scene, data.cover, "vertebrae_L3", [l](float x, float d, float z) { return vertebra(l, x, d, z); });
  add_bone(scene, data.cover, "vertebrae_L4", [l](float x, float d, float z) { return vertebra(l, x, d, -z); });
  scene.shapes.push_back(
      {"epidural_fat", kFatLayerHu, 5.0F, [l](float x, float d, float) { return canal(l, x, d, 0.0F); }});
  scene.shapes.push_back({"csf", kCsfHu, 0.0F, [l](float x, float d, float) {
                            const float half = 0.5F * (l.sac_end - l.dura);
                            return elliptic_cylinder(x, d - l.dura - half, l.sac_half_width, half);
                          }});
  return scene;
}

LayerScene ascites_scene(const LayerData& data) {
  const AscitesLayers l = data.ascites;
  LayerScene scene;
  scene.target_mm = 0.5F * (l.peritoneum + l.bowel);
  scene.path_name = "paracentesis";
  add_cover(scene, data.cover);
  scene.shapes.push_back(
      {"muscle", kMuscleLayerHu, 7.0F, [l](float, float d, float) { return slab(d, l.muscle, l.muscle_end); }});
  scene.shapes.push_back({"ascites", kAscitesHu, 0.0F, [l](float, float d, float) {
                            return slab(d, l.peritoneum, l.bowel + l.fluid_behind_bowel);
                          }});
  scene.shapes.push_back(
      {"iliopsoas_left", kMuscleLayerHu, 7.0F, [l](float, float d, float) { return slab(d, l.psoas, kEnd); }});
  add_loop(scene, l, l.loop_z, false);
  for (const float z : l.gas_loops_z) add_loop(scene, l, z, true);
  return scene;
}

LayerScene liver_scene(const LayerData& data) {
  const LiverLayers l = data.liver;
  LayerScene scene;
  scene.target_mm = l.duct;
  scene.path_name = "bile duct puncture";
  add_cover(scene, data.cover);
  scene.shapes.push_back(
      {"muscle", kMuscleLayerHu, 7.0F, [l](float, float d, float) { return slab(d, l.muscle, l.peritoneum); }});
  scene.shapes.push_back(
      {"peritoneum", kPeritoneumHu, 0.0F, [l](float, float d, float) { return slab(d, l.peritoneum, l.capsule); }});
  scene.shapes.push_back(
      {"liver", kLiverLayerHu, 6.0F, [l](float, float d, float) { return slab(d, l.capsule, l.end); }});
  scene.shapes.push_back({"portal_vein", kPortalBranchHu, 3.0F,
                          [l](float, float d, float z) { return std::hypot(d - l.vein, z) - l.vein_radius; }});
  scene.shapes.push_back({"bile_duct", kDuctLumenHu, 0.0F,
                          [l](float, float d, float z) { return std::hypot(d - l.duct, z) - l.duct_radius; }});
  add_bone(scene, data.cover, "rib_right_9",
           [l](float, float d, float z) { return std::hypot(d - l.rib_depth, z - l.rib_z) - l.rib_radius; });
  add_bone(scene, data.cover, "rib_right_10",
           [l](float, float d, float z) { return std::hypot(d - l.rib_depth, z + l.rib_z) - l.rib_radius; });
  return scene;
}

namespace {

/// Keeps an error if the depths do not increase.
void check_order(SectionReader& section, std::string_view last_key, std::initializer_list<float> depths) {
  if (!std::is_sorted(depths.begin(), depths.end()))
    section.refuse(last_key, "the layers do not follow each other on the path", "correct the depths of the section");
}

LumbarLayers read_lumbar_layers(SectionReader s) {
  const LumbarLayers layers{.supraspinous = s.length("supraspinous_mm"),
                            .interspinous = s.length("interspinous_mm"),
                            .flavum = s.length("flavum_mm"),
                            .epidural = s.length("epidural_mm"),
                            .dura = s.length("dura_mm"),
                            .sac_end = s.length("sac_end_mm"),
                            .canal_end = s.length("canal_end_mm"),
                            .target_behind_dura = s.length("target_behind_dura_mm"),
                            .supraspinous_half_width = s.length("supraspinous_half_width_mm"),
                            .flavum_end = s.length("flavum_end_mm"),
                            .canal_half_width = s.length("canal_half_width_mm"),
                            .sac_half_width = s.length("sac_half_width_mm"),
                            .body = s.ellipse("body"),
                            .disc_half_height = s.length("disc_half_height_mm"),
                            .gap_half = s.length("gap_half_mm"),
                            .spinous_half_width = s.length("spinous_half_width_mm"),
                            .spinous_end = s.length("spinous_end_mm"),
                            .spinous_top = s.length("spinous_top_mm"),
                            .lamina = s.length("lamina_mm"),
                            .lamina_end = s.length("lamina_end_mm"),
                            .lamina_top = s.length("lamina_top_mm"),
                            .pedicle_x = s.length("pedicle_x_mm"),
                            .pedicle_half_width = s.length("pedicle_half_width_mm"),
                            .pedicle_depths = s.lengths<2>("pedicle_depths_mm"),
                            .pedicle_z = s.length("pedicle_z_mm"),
                            .pedicle_half_height = s.length("pedicle_half_height_mm"),
                            .facet_x = s.length("facet_x_mm"),
                            .facet_depth = s.length("facet_depth_mm"),
                            .facet_radius = s.length("facet_radius_mm"),
                            .facet_gap_half = s.length("facet_gap_half_mm"),
                            .erector_x = s.length("erector_x_mm"),
                            .erector_depths = s.lengths<2>("erector_depths_mm"),
                            .psoas_x = s.length("psoas_x_mm"),
                            .psoas_depths = s.lengths<2>("psoas_depths_mm")};
  check_order(s, "canal_end_mm",
              {layers.supraspinous, layers.interspinous, layers.flavum, layers.epidural, layers.dura, layers.sac_end,
               layers.canal_end});
  return layers;
}

AscitesLayers read_ascites_layers(SectionReader s) {
  const AscitesLayers layers{.muscle = s.length("muscle_mm"),
                             .muscle_end = s.length("muscle_end_mm"),
                             .peritoneum = s.length("peritoneum_mm"),
                             .bowel = s.length("bowel_mm"),
                             .fluid_behind_bowel = s.length("fluid_behind_bowel_mm"),
                             .psoas = s.length("psoas_mm"),
                             .loop_radius = s.length("loop_radius_mm"),
                             .loop_wall = s.length("loop_wall_mm"),
                             .loop_z = s.number("loop_z_mm"),
                             .gas_loops_z = s.numbers<2>("gas_loops_z_mm"),
                             .gas = s.length("gas_mm")};
  check_order(s, "psoas_mm", {layers.muscle, layers.muscle_end, layers.peritoneum, layers.bowel, layers.psoas});
  return layers;
}

LiverLayers read_liver_layers(SectionReader s) {
  const LiverLayers layers{.muscle = s.length("muscle_mm"),
                           .peritoneum = s.length("peritoneum_mm"),
                           .capsule = s.length("capsule_mm"),
                           .end = s.length("end_mm"),
                           .duct = s.length("duct_mm"),
                           .duct_radius = s.length("duct_radius_mm"),
                           .vein = s.length("vein_mm"),
                           .vein_radius = s.length("vein_radius_mm"),
                           .rib_depth = s.length("rib_depth_mm"),
                           .rib_z = s.length("rib_z_mm"),
                           .rib_radius = s.length("rib_radius_mm")};
  check_order(s, "end_mm", {layers.muscle, layers.peritoneum, layers.capsule, layers.duct, layers.vein, layers.end});
  return layers;
}

}  // namespace

Result<LayerData> load_layer_data(const std::filesystem::path& path) {
  TROCAR_TRY(config::TomlTable document, config::load_toml(path));
  ReadState state;
  SectionReader file(std::move(document), state);
  SectionReader cover = file.section("cover");
  const LayerData data{.cover = {cover.length("skin_mm"), cover.length("bone_cortex_mm")},
                       .lumbar = read_lumbar_layers(file.section("lumbar")),
                       .ascites = read_ascites_layers(file.section("ascites")),
                       .liver = read_liver_layers(file.section("liver"))};
  TROCAR_TRY_STATUS(state.finish());
  return data;
}

}  // namespace trocar::phantom
