#include "phantom/phantom_data.h"

#include <algorithm>

#include "phantom/section_reader.h"

namespace trocar::phantom {
namespace {

TorsoData read_torso(SectionReader torso, SectionReader diaphragm) {
  SectionReader skin = torso.section("skin");
  SectionReader fat = torso.section("fat");
  SectionReader muscle = torso.section("muscle");
  SectionReader pelvis = torso.section("pelvis");
  return {.half_width_mm = torso.size("half_width_mm"),
          .half_depth_mm = torso.size("half_depth_mm"),
          .back_depth_mm = torso.length("back_depth_mm"),
          .umbilicus_z_mm = torso.number("umbilicus_z_mm"),
          .waves_mm = torso.range("waves_mm"),
          .skin = {.waist_z = skin.hill("waist_z"),
                   .chest_taper_z = skin.rise("chest_taper_z"),
                   .chest_depth_z = skin.rise("chest_depth_z"),
                   .belly_z = skin.hill("belly_z"),
                   .spinal_furrow = skin.hill("spinal_furrow"),
                   .spinal_furrow_chest_z = skin.rise("spinal_furrow_chest_z"),
                   .erector = skin.hill_deg("erector_deg"),
                   .linea_alba = skin.hill("linea_alba"),
                   .umbilicus = skin.hill("umbilicus")},
          .fat = {.factor = fat.size("factor"),
                  .least_mm = fat.length("least_mm"),
                  .chest_z = fat.transition("chest_z"),
                  .flank = fat.hill_deg("flank_deg"),
                  .flank_chest_share = fat.number("flank_chest_share"),
                  .loin = fat.hill_deg("loin_deg"),
                  .loin_z = fat.transition("loin_z"),
                  .front_mm = fat.numbers<2>("front_mm"),
                  .front = fat.unit_hill_deg("front_deg"),
                  .umbilicus = fat.hill("umbilicus")},
          .muscle = {.least_mm = muscle.length("least_mm"),
                     .chest_z = muscle.transition("chest_z"),
                     .back_mm = muscle.numbers<2>("back_mm"),
                     .back_width = muscle.degrees("back_width_deg"),
                     .lateral_mm = muscle.numbers<2>("lateral_mm"),
                     .lateral = muscle.unit_hill_deg("lateral_deg"),
                     .linea_alba_mm = muscle.number("linea_alba_mm"),
                     .linea_alba_width = muscle.degrees("linea_alba_width_deg")},
          .pelvis = {.hip_z = pelvis.hill("hip_z"),
                     .lower_belly_z = pelvis.rise("lower_belly_z"),
                     .buttock_z = pelvis.hill("buttock_z"),
                     .buttock = pelvis.unit_hill_deg("buttock_deg"),
                     .cleft_z = pelvis.rise("cleft_z"),
                     .hip_fat_z = pelvis.hill("hip_fat_z"),
                     .upper_wall_z = pelvis.rise("upper_wall_z"),
                     .lower_wall_z = pelvis.rise("lower_wall_z"),
                     .wall = pelvis.unit_hill_deg("wall_deg"),
                     .back_wall_z = pelvis.rise("back_wall_z"),
                     .back_wall_width = pelvis.degrees("back_wall_width_deg"),
                     .bulge = pelvis.unit_hill_deg("bulge_deg"),
                     .bulge_z = pelvis.unit_hill("bulge_z")},
          .diaphragm = {.rim_back_mm = diaphragm.number("rim_back_mm"),
                        .rim_side = diaphragm.rise_deg("rim_side_deg"),
                        .rim_front = diaphragm.rise_deg("rim_front_deg"),
                        .dome_mm = diaphragm.number("dome_mm"),
                        .dome_spread_mm = diaphragm.range("dome_spread_mm"),
                        .right_dome_x = diaphragm.hill("right_dome_x"),
                        .right_dome_y = diaphragm.unit_hill("right_dome_y"),
                        .left_dome_x = diaphragm.hill("left_dome_x"),
                        .left_dome_y = diaphragm.unit_hill("left_dome_y"),
                        .rise_mm = diaphragm.length("rise_mm")}};
}

LandmarkData read_landmarks(SectionReader landmarks) {
  return {.xiphoid_z_mm = landmarks.number("xiphoid_z_mm"),
          .tenth_rib_below_t10_mm = landmarks.number("tenth_rib_below_t10_mm")};
}

std::vector<SpineInclination> read_inclinations(SectionReader& spine) {
  std::vector<SpineInclination> inclinations;
  for (const std::vector<double>& row : spine.rows("inclinations", 3)) {
    const auto number = [&](std::size_t n) { return static_cast<float>(row[n]); };
    inclinations.push_back({number(0), number(1) * kDegree, number(2) * kDegree});
  }
  const auto is_above = [](const SpineInclination& a, const SpineInclination& b) { return a.s_mm > b.s_mm; };
  if (!std::is_sorted(inclinations.begin(), inclinations.end(), is_above))
    spine.refuse("inclinations", "the rows do not go down", "order them from the head to the feet");
  return inclinations;
}

SpineData read_spine(SectionReader spine) {
  const SpineData data{.heights_mm = spine.numbers<SpineData::kLevels>("heights_mm"),
                       .anchor_y_mm = spine.number("anchor_y_mm"),
                       .inclinations = read_inclinations(spine),
                       .body_half_width_mm = spine.length("body_half_width_mm"),
                       .body_half_depth_mm = spine.length("body_half_depth_mm"),
                       .body_waist_mm = spine.number("body_waist_mm"),
                       .body_hollow = spine.lengths<2>("body_hollow"),
                       .canal_y_mm = spine.number("canal_y_mm"),
                       .canal_radii_mm = spine.lengths<2>("canal_radii_mm"),
                       .cord_y_mm = spine.number("cord_y_mm"),
                       .cord_radii_mm = spine.lengths<2>("cord_radii_mm"),
                       .cord_end_z = spine.transition("cord_end_z"),
                       .disc_half_height_mm = spine.length("disc_half_height_mm")};
  if (!std::is_sorted(data.heights_mm.rbegin(), data.heights_mm.rend()))
    spine.refuse("heights_mm", "the vertebrae do not go down from T5 to L5", "correct the heights");
  return data;
}

VertebraData read_vertebra(SectionReader vertebra) {
  return {.size = vertebra.length("size"),
          .half_disc_mm = vertebra.length("half_disc_mm"),
          .paired = vertebra.cones("paired"),
          .spinous = vertebra.cones("spinous")};
}

RibData read_ribs(SectionReader ribs) {
  SectionReader neck = ribs.section("neck");
  return {.outward_mm = ribs.number("outward_mm"),
          .half_thickness_mm = ribs.length("half_thickness_mm"),
          .half_height_mm = ribs.length("half_height_mm"),
          .begin_deg = ribs.number("begin_deg"),
          .ends_deg = ribs.numbers<RibData::kLast - RibData::kFirst + 1>("ends_deg"),
          .fall_mm = ribs.number("fall_mm"),
          .head_above_mm = ribs.number("head_above_mm"),
          .neck = {.first_rib = neck.integer("first_rib", {RibData::kFirst, RibData::kLast}),
                   .begin_deg = neck.number("begin_deg"),
                   .head = neck.knot("head"),
                   .tubercle_x_mm = neck.number("tubercle_x_mm"),
                   .tubercle_share = neck.number("tubercle_share"),
                   .tubercle_above_mm = neck.number("tubercle_above_mm"),
                   .tubercle_radius_mm = neck.length("tubercle_radius_mm"),
                   .angle_radius_mm = neck.length("angle_radius_mm")}};
}

CartilageData read_cartilages(SectionReader cartilages) {
  CartilageData data{
      .courses = {}, .radii_mm = cartilages.lengths<5>("radii_mm"), .sag_mm = cartilages.number("sag_mm")};
  for (const std::vector<double>& row : cartilages.rows("courses", 5)) {
    const auto number = [&](std::size_t n) { return static_cast<float>(row[n]); };
    const CartilageData::Path path{static_cast<int>(row[0]), number(1), number(2), number(3), number(4)};
    if (path.rib < RibData::kFirst || path.rib > RibData::kLast || static_cast<double>(path.rib) != row[0])
      cartilages.refuse("courses", "there is no such rib", "begin each row with a rib from 5 to 12");
    data.courses.push_back(path);
  }
  return data;
}

SternumData read_sternum(SectionReader sternum) {
  return {.outward_mm = sternum.number("outward_mm"),
          .z_mm = sternum.number("z_mm"),
          .half_width_mm = sternum.length("half_width_mm"),
          .half_height_mm = sternum.length("half_height_mm"),
          .xiphoid_z_mm = sternum.number("xiphoid_z_mm"),
          .xiphoid_half_width_mm = sternum.length("xiphoid_half_width_mm"),
          .xiphoid_half_height_mm = sternum.length("xiphoid_half_height_mm"),
          .half_thickness_mm = sternum.length("half_thickness_mm")};
}

BackMuscleData read_back_muscles(SectionReader muscles) {
  SectionReader quadratus = muscles.section("quadratus_lumborum");
  return {.chest_z = muscles.transition("chest_z"),
          .multifidus = muscles.ellipse("multifidus"),
          .outer_lumbar = muscles.ellipse("outer_lumbar"),
          .outer_thoracic = muscles.ellipse("outer_thoracic"),
          .psoas = muscles.course("psoas"),
          .crus = muscles.course("crus"),
          .quadratus_lumborum = {.x_mm = quadratus.number("x_mm"),
                                 .y_mm = quadratus.number("y_mm"),
                                 .upper_radii_mm = quadratus.lengths<2>("upper_radii_mm"),
                                 .wider_mm = quadratus.lengths<2>("wider_mm"),
                                 .wider_z = quadratus.transition("wider_z"),
                                 .slant = quadratus.number("slant"),
                                 .top_z_mm = quadratus.number("top_z_mm")}};
}

HeartData read_heart(SectionReader heart) {
  return {.x_mm = heart.range("x_mm"),
          .y_mm = heart.number("y_mm"),
          .z_mm = heart.range("z_mm"),
          .radii_mm = heart.radii("radii_mm"),
          .mediastinum = heart.ellipse("mediastinum")};
}

StomachData read_stomach(SectionReader stomach) {
  return {.course = stomach.course("course"),
          .radius_spread = stomach.number("radius_spread"),
          .fluid_level_y_mm = stomach.number("fluid_level_y_mm"),
          .fluid_level_spread_mm = stomach.number("fluid_level_spread_mm")};
}

SmallBowelData read_small_bowel(SectionReader bowel) {
  constexpr config::Range kCounts{1, 20};
  const SmallBowelData data{.first = bowel.point("first"),
                            .step = bowel.point("step"),
                            .columns = bowel.integer("columns", kCounts),
                            .layers = bowel.integer("layers", kCounts),
                            .rows = bowel.integer("rows", kCounts),
                            .first_upper_column = bowel.integer("first_upper_column", {0, kCounts.high}),
                            .stagger_mm = bowel.number("stagger_mm"),
                            .slant_mm = bowel.number("slant_mm"),
                            .radius_mm = bowel.length("radius_mm"),
                            .spread = bowel.point("spread"),
                            .radius_spread_mm = bowel.number("radius_spread_mm"),
                            .folds = bowel.folds("folds_mm")};
  if (data.radius_spread_mm < 0.0F || data.radius_spread_mm >= data.radius_mm)
    bowel.refuse("radius_spread_mm", "the bowel can become thinner than nothing", "give less than radius_mm");
  if (data.first_upper_column >= data.columns || data.columns * data.layers * data.rows < 2)
    bowel.refuse("first_upper_column", "the serpentine is too short", "give more columns, layers or rows");
  return data;
}

ColonData read_colon(SectionReader colon) {
  ColonData data{.course = colon.course("course"),
                 .hanging_knots = {},
                 .hanging_spread_mm = colon.number("hanging_spread_mm"),
                 .spread = colon.point("spread"),
                 .folds = colon.folds("folds_mm")};
  const auto knots = colon.numbers<2>("hanging_knots");
  const auto count = static_cast<float>(data.course.size());
  if (knots[0] < 1.0F || knots[1] < knots[0] || knots[1] > count)
    colon.refuse("hanging_knots", "there are no such knots", "write [first, last], counted from 1");
  else
    data.hanging_knots = {static_cast<std::size_t>(knots[0]) - 1, static_cast<std::size_t>(knots[1]) - 1};
  return data;
}

SpleenData read_spleen(SectionReader spleen) {
  return {.centre = spleen.point("centre"),
          .spread_mm = spleen.number("spread_mm"),
          .radii_mm = spleen.radii("radii_mm"),
          .size = spleen.size("size"),
          .hollow_centre = spleen.point("hollow_centre"),
          .hollow_radii_mm = spleen.radii("hollow_radii_mm")};
}

KidneyData read_kidneys(SectionReader kidneys) {
  return {.right_centre = kidneys.point("right_centre"),
          .left_centre = kidneys.point("left_centre"),
          .spread_mm = kidneys.number("spread_mm"),
          .size = kidneys.size("size"),
          .radii_mm = kidneys.radii("radii_mm"),
          .hilum_centre = kidneys.point("hilum_centre"),
          .hilum_radii_mm = kidneys.radii("hilum_radii_mm"),
          .sinus_centre = kidneys.point("sinus_centre"),
          .sinus_radii_mm = kidneys.radii("sinus_radii_mm"),
          .capsule_centre = kidneys.point("capsule_centre"),
          .capsule_radii_mm = kidneys.radii("capsule_radii_mm")};
}

LiverData read_liver(SectionReader liver) {
  return {.size = liver.size("size"),
          .right_centre = liver.point("right_centre"),
          .right_radii_mm = liver.radii("right_radii_mm"),
          .left_reach_mm = liver.range("left_reach_mm"),
          .left_centre = liver.point("left_centre"),
          .left_radii_mm = liver.radii("left_radii_mm"),
          .tip_z_mm = liver.range("tip_z_mm"),
          .tip_x_mm = liver.number("tip_x_mm"),
          .visceral_slope = liver.numbers<2>("visceral_slope"),
          .visceral_hollow_x = liver.hill("visceral_hollow_x"),
          .spine_space = liver.ellipse("spine_space"),
          .porta_centre = liver.point("porta_centre"),
          .porta_radii_mm = liver.radii("porta_radii_mm"),
          .fissure_x_mm = liver.number("fissure_x_mm"),
          .fissure_y_mm = liver.number("fissure_y_mm"),
          .hilum = liver.point("hilum"),
          .venous_confluence = liver.point("venous_confluence")};
}

std::vector<Course> read_branches(SectionReader branches) {
  constexpr std::size_t kMost = 20;
  std::vector<Course> courses;
  if (branches.keys().size() > kMost) {
    branches.refuse(branches.keys().front(), "there are more than 20 branches", "remove some");
    return courses;
  }
  for (const std::string& name : branches.keys()) courses.push_back(branches.course(name));
  return courses;
}

AortaData read_aorta(SectionReader aorta) {
  return {.chest = aorta.course("chest"),
          .spine_front_mm = aorta.number("spine_front_mm"),
          .before_spine = aorta.course("before_spine"),
          .branches = read_branches(aorta.section("branches"))};
}

VeinData read_vein(SectionReader vein) {
  return {.course = vein.course("course"), .branches = read_branches(vein.section("branches"))};
}

VeinData read_portal_vein(SectionReader vein, const Vec3f& hilum) {
  VeinData data = read_vein(vein);
  data.course.push_back({hilum, vein.length("hilum_radius_mm")});
  return data;
}

TreeData read_tree(SectionReader tree) {
  const TreeData data{.direction = tree.point("direction"),
                      .root_radius_mm = tree.length("root_radius_mm"),
                      .root_share = tree.length("root_share"),
                      .least_radius_mm = tree.length("least_radius_mm")};
  if (data.direction.norm() == 0.0F) tree.refuse("direction", "the direction is zero", "give a vector");
  return data;
}

LesionData read_lesions(SectionReader lesions) {
  return {.gate_deg = lesions.range("gate_deg"),
          .gate_z_mm = lesions.range("gate_z_mm"),
          .gate_outward_mm = lesions.number("gate_outward_mm"),
          .direction_spread = lesions.spreads("direction_spread"),
          .depth_mm = lesions.range("depth_mm"),
          .radius_mm = lesions.size("radius_mm"),
          .other_radius_mm = lesions.size("other_radius_mm"),
          .apart_mm = lesions.number("apart_mm"),
          .from_hilum_mm = lesions.number("from_hilum_mm"),
          .longest_path_mm = lesions.length("longest_path_mm")};
}

EpigastricData read_epigastric(SectionReader vessels) {
  EpigastricData data{
      .course = {}, .radius_mm = vessels.length("radius_mm"), .outward_mm = vessels.number("outward_mm")};
  for (const std::vector<double>& row : vessels.rows("course", 2))
    data.course.push_back({static_cast<float>(row[0]), static_cast<float>(row[1])});
  return data;
}

BileDuctData read_bile_duct(SectionReader duct) {
  BileDuctData data{.course = {},
                    .beside = duct.point("beside").normalized(),
                    .artery_beside = duct.point("artery_beside").normalized(),
                    .narrow_radius_mm = duct.length("narrow_radius_mm"),
                    .tumour_radius_mm = duct.length("tumour_radius_mm")};
  for (const std::vector<double>& row : duct.rows("course", 3))
    data.course.push_back(Vec3(row[0], row[1], row[2]).cast<float>());
  return data;
}

PhaseData read_phase(SectionReader phase) {
  PhaseData shifts;
  for (const std::string& label : phase.keys()) shifts.emplace_back(label, phase.number(label));
  return shifts;
}

AbdomenData read_abdomen(SectionReader file) {
  SectionReader vertebrae = file.section("vertebrae");
  SectionReader oesophagus = file.section("oesophagus");
  SectionReader duodenum = file.section("duodenum");
  SectionReader pancreas = file.section("pancreas");
  SectionReader adrenal_glands = file.section("adrenal_glands");
  SectionReader gallbladder = file.section("gallbladder");
  SectionReader bladder = file.section("bladder");
  SectionReader uterus = file.section("uterus");
  SectionReader phases = file.section("phases");
  const LiverData liver = read_liver(file.section("liver"));
  return {.torso = read_torso(file.section("torso"), file.section("diaphragm")),
          .landmarks = read_landmarks(file.section("landmarks")),
          .spine = read_spine(file.section("spine")),
          .thoracic_vertebra = read_vertebra(vertebrae.section("thoracic")),
          .lumbar_vertebra = read_vertebra(vertebrae.section("lumbar")),
          .ribs = read_ribs(file.section("ribs")),
          .cartilages = read_cartilages(file.section("cartilages")),
          .sternum = read_sternum(file.section("sternum")),
          .back_muscles = read_back_muscles(file.section("back_muscles")),
          .heart = read_heart(file.section("heart")),
          .oesophagus = oesophagus.course("course"),
          .stomach = read_stomach(file.section("stomach")),
          .duodenum = {.course = duodenum.course("course"), .folds = duodenum.folds("folds_mm")},
          .small_bowel = read_small_bowel(file.section("small_bowel")),
          .colon = read_colon(file.section("colon")),
          .spleen = read_spleen(file.section("spleen")),
          .pancreas = {.course = pancreas.course("course"), .spread_mm = pancreas.number("spread_mm")},
          .kidneys = read_kidneys(file.section("kidneys")),
          .adrenal_glands = {.top = adrenal_glands.point("top"), .course = adrenal_glands.course("course")},
          .liver = liver,
          .gallbladder = {.x_mm = gallbladder.range("x_mm"), .course = gallbladder.course("course")},
          .aorta = read_aorta(file.section("aorta")),
          .vena_cava = read_vein(file.section("vena_cava")),
          .epigastric = read_epigastric(file.section("epigastric_vessels")),
          .bladder = {.centre = bladder.point("centre"),
                      .radii_mm = bladder.radii("radii_mm"),
                      .size = bladder.size("size")},
          .uterus = {.centre = uterus.point("centre"),
                     .radii_mm = uterus.radii("radii_mm"),
                     .spread_mm = uterus.number("spread_mm")},
          .portal_vein = read_portal_vein(file.section("portal_vein"), liver.hilum),
          .portal_tree = read_tree(file.section("portal_tree")),
          .hepatic_tree = read_tree(file.section("hepatic_tree")),
          .bile_duct = read_bile_duct(file.section("bile_duct")),
          .lesions = read_lesions(file.section("lesions")),
          .native = read_phase(phases.section("native")),
          .arterial = read_phase(phases.section("arterial"))};
}

}  // namespace

float SpineData::height(int level) const {
  return heights_mm[static_cast<std::size_t>(std::clamp(level, 0, static_cast<int>(kLevels) - 1))];
}

Result<AbdomenData> load_abdomen_data(const std::filesystem::path& path) {
  TROCAR_TRY(config::TomlTable document, config::load_toml(path));
  ReadState state;
  AbdomenData data = read_abdomen(SectionReader(std::move(document), state));
  TROCAR_TRY_STATUS(state.finish());
  return data;
}

}  // namespace trocar::phantom
