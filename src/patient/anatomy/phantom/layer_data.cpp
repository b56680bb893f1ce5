#include "anatomy/phantom/layer_data.h"

#include <algorithm>
#include <initializer_list>

#include "anatomy/phantom/section_reader.h"

namespace trocar::anatomy::phantom {
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

}  // namespace trocar::anatomy::phantom
