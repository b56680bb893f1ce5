#include "patient_builder/plausibility/detail/usual_places.h"

#include <algorithm>
#include <array>

namespace trocar::patient_builder::detail {
namespace {

// Contrast agent makes vessels, the kidneys, the bladder and bowel bright; gas makes bowel dark.
constexpr std::array kUsualHus{UsualHu{"urinary_bladder", -30, 3100},
                               UsualHu{"kidney_cyst_left", -30, 90},
                               UsualHu{"kidney_cyst_right", -30, 90},
                               UsualHu{"kidney_cyst", -30, 90},
                               UsualHu{"bone", 60, 1500},
                               UsualHu{"lung", -1010, -350},
                               UsualHu{"liver", 0, 200},
                               UsualHu{"liver_lesion", -40, 250},
                               UsualHu{"spleen", 15, 250},
                               UsualHu{"kidney", 5, 500},
                               UsualHu{"organ", -40, 180},
                               UsualHu{"bowel", -600, 300},
                               UsualHu{"vessel", 0, 700},
                               UsualHu{"muscle", -40, 120},
                               UsualHu{"gallbladder", -30, 120},
                               UsualHu{"fluid", -30, 100},
                               UsualHu{"csf", -30, 90},
                               UsualHu{"nerve", -20, 120},
                               UsualHu{"adipose", -140, -20},
                               UsualHu{"cartilage", 20, 400},
                               UsualHu{"soft_tissue", -100, 160}};

constexpr UsualSize kUsualVertebra{"vertebra", 0, 180, 40};
constexpr std::array kUsualSizes{UsualSize{"liver", 0, 3500, 75},
                                 UsualSize{"spleen", 0, 1100, 45},
                                 UsualSize{"kidney_left", 0, 600, 35},
                                 UsualSize{"kidney", 0, 700, 95},
                                 UsualSize{"kidneys", 0, 900, 95},
                                 UsualSize{"hepatic_vessels", 0, 250, 60},
                                 UsualSize{"kidney_right", 0, 600, 35},
                                 UsualSize{"kidney_cyst_left", 0, 1000, 40},
                                 UsualSize{"kidney_cyst_right", 0, 1000, 40},
                                 UsualSize{"gallbladder", 0, 250, 30},
                                 UsualSize{"stomach", 0, 2500, 75},
                                 UsualSize{"pancreas", 0, 250, 55},
                                 UsualSize{"adrenal_gland_left", 0, 60, 25},
                                 UsualSize{"adrenal_gland_right", 0, 60, 25},
                                 UsualSize{"adrenal_glands", 0, 120, 60},
                                 UsualSize{"esophagus", 0, 150, 30},
                                 UsualSize{"duodenum", 0, 350, 50},
                                 UsualSize{"trachea", 0, 150, 30},
                                 UsualSize{"thyroid_gland", 0, 150, 35},
                                 UsualSize{"aorta", 0, 700, 40},
                                 UsualSize{"inferior_vena_cava", 0, 350, 35},
                                 UsualSize{"portal_vein_and_splenic_vein", 0, 200, 50},
                                 UsualSize{"urinary_bladder", 0, 2000, 60},
                                 UsualSize{"prostate", 0, 300, 35}};

constexpr double kAnywhere_mm = 1e6;

struct NamedSide {
  std::string_view name;
  UsualSide side;
};
constexpr std::array kUsualSides{NamedSide{"liver", {0, -kAnywhere_mm, -5}},
                                 NamedSide{"liver", {1, -kAnywhere_mm, 40}},
                                 NamedSide{"spleen", {0, 25, kAnywhere_mm}},
                                 NamedSide{"spleen", {1, -40, kAnywhere_mm}},
                                 NamedSide{"gallbladder", {0, -kAnywhere_mm, 10}},
                                 NamedSide{"gallbladder", {1, -kAnywhere_mm, 20}},
                                 NamedSide{"stomach", {0, -20, kAnywhere_mm}},
                                 NamedSide{"stomach", {1, -kAnywhere_mm, 30}},
                                 NamedSide{"pancreas", {1, -kAnywhere_mm, 30}},
                                 NamedSide{"pancreas", {0, -35, 50}},
                                 NamedSide{"urinary_bladder", {0, -45, 45}},
                                 NamedSide{"urinary_bladder", {1, -kAnywhere_mm, 30}},
                                 NamedSide{"prostate", {0, -30, 30}},
                                 NamedSide{"prostate", {1, -kAnywhere_mm, 45}},
                                 NamedSide{"aorta", {1, -35, kAnywhere_mm}},
                                 NamedSide{"inferior_vena_cava", {1, -45, kAnywhere_mm}},
                                 NamedSide{"inferior_vena_cava", {0, -60, 25}},
                                 NamedSide{"aorta", {0, -25, 60}},
                                 NamedSide{"adrenal_gland_left", {1, -30, kAnywhere_mm}},
                                 NamedSide{"adrenal_gland_right", {1, -30, kAnywhere_mm}},
                                 NamedSide{"kidney_left", {1, -25, kAnywhere_mm}},
                                 NamedSide{"kidney_right", {1, -25, kAnywhere_mm}},
                                 NamedSide{"kidneys", {0, -50, 50}},
                                 NamedSide{"lungs", {0, -60, 60}}};

// They lie near the middle, on either side of it: "left" is their side of the heart or of their branching.
constexpr std::array<std::string_view, 7> kNearMiddle{
    "heart", "atrial", "brachiocephalic", "common_carotid", "subclavian", "pulmonary", "iliac"};
constexpr std::array<std::string_view, 7> kFarFromMiddle{"kidney", "lung", "femur", "hip", "humerus", "scapula", "rib"};

constexpr int kToLeft = 0, kToBack = 1, kToHead = 2;
constexpr std::array kUsualRelations{UsualRelation{"spleen", kToLeft, "liver", 20},
                                     UsualRelation{"spleen", kToLeft, "gallbladder", 20},
                                     UsualRelation{"spleen", kToLeft, "kidney_right", 30},
                                     UsualRelation{"spleen", kToLeft, "pancreas", 0},
                                     UsualRelation{"spleen", kToLeft, "inferior_vena_cava", 15},
                                     UsualRelation{"stomach", kToLeft, "liver", 0},
                                     UsualRelation{"stomach", kToLeft, "gallbladder", 0},
                                     UsualRelation{"kidney_left", kToLeft, "liver", 20},
                                     UsualRelation{"kidney_left", kToLeft, "gallbladder", 20},
                                     UsualRelation{"kidney_left", kToLeft, "kidney_right", 30},
                                     UsualRelation{"kidney_left", kToLeft, "aorta", 10},
                                     UsualRelation{"kidney_left", kToLeft, "inferior_vena_cava", 15},
                                     UsualRelation{"aorta", kToLeft, "kidney_right", 10},
                                     UsualRelation{"aorta", kToLeft, "liver", 10},
                                     UsualRelation{"aorta", kToLeft, "inferior_vena_cava", -8},
                                     UsualRelation{"inferior_vena_cava", kToLeft, "kidney_right", 5},
                                     UsualRelation{"adrenal_gland_left", kToLeft, "adrenal_gland_right", 15},
                                     UsualRelation{"adrenal_gland_left", kToLeft, "liver", 10},
                                     UsualRelation{"pancreas", kToLeft, "gallbladder", -10},
                                     UsualRelation{"pancreas", kToLeft, "kidney_right", 10},
                                     UsualRelation{"kidney_left", kToBack, "stomach", -10},
                                     UsualRelation{"kidney_left", kToBack, "pancreas", -5},
                                     UsualRelation{"kidney_right", kToBack, "gallbladder", 0},
                                     UsualRelation{"kidney_right", kToBack, "liver", -20},
                                     UsualRelation{"kidney_right", kToBack, "pancreas", -5},
                                     UsualRelation{"aorta", kToBack, "pancreas", -5},
                                     UsualRelation{"aorta", kToBack, "gallbladder", 5},
                                     UsualRelation{"aorta", kToBack, "stomach", -10},
                                     UsualRelation{"aorta", kToBack, "portal_vein_and_splenic_vein", -5},
                                     UsualRelation{"inferior_vena_cava", kToBack, "pancreas", -10},
                                     UsualRelation{"inferior_vena_cava", kToBack, "gallbladder", 0},
                                     UsualRelation{"inferior_vena_cava", kToBack, "portal_vein_and_splenic_vein", -10},
                                     UsualRelation{"adrenal_gland_left", kToBack, "pancreas", -5},
                                     UsualRelation{"adrenal_gland_left", kToBack, "stomach", -15},
                                     UsualRelation{"adrenal_gland_right", kToBack, "pancreas", -5},
                                     UsualRelation{"adrenal_gland_right", kToBack, "gallbladder", 10},
                                     UsualRelation{"adrenal_gland_right", kToBack, "inferior_vena_cava", -20},
                                     UsualRelation{"esophagus", kToBack, "stomach", -10},
                                     UsualRelation{"esophagus", kToBack, "gallbladder", 15},
                                     UsualRelation{kSpine, kToBack, "aorta", 0},
                                     UsualRelation{kSpine, kToBack, "inferior_vena_cava", 0},
                                     UsualRelation{kSpine, kToBack, "pancreas", 10},
                                     UsualRelation{kSpine, kToBack, "gallbladder", 20},
                                     UsualRelation{kSpine, kToBack, "stomach", 10},
                                     UsualRelation{kSpine, kToBack, "liver", 0},
                                     UsualRelation{kSpine, kToBack, "urinary_bladder", 10},
                                     UsualRelation{"rectum", kToBack, "urinary_bladder", 10},
                                     UsualRelation{"liver", kToHead, "urinary_bladder", 60},
                                     UsualRelation{"spleen", kToHead, "urinary_bladder", 60},
                                     UsualRelation{"stomach", kToHead, "urinary_bladder", 40},
                                     UsualRelation{"pancreas", kToHead, "urinary_bladder", 40},
                                     UsualRelation{"gallbladder", kToHead, "urinary_bladder", 40},
                                     UsualRelation{"kidney_left", kToHead, "urinary_bladder", 30},
                                     UsualRelation{"kidney_right", kToHead, "urinary_bladder", 30},
                                     UsualRelation{"aorta", kToHead, "urinary_bladder", 20},
                                     UsualRelation{"duodenum", kToHead, "urinary_bladder", 20},
                                     UsualRelation{"colon", kToHead, "urinary_bladder", 0},
                                     UsualRelation{"lungs", kToHead, "urinary_bladder", 100},
                                     UsualRelation{"liver", kToHead, "prostate", 80},
                                     UsualRelation{"liver", kToHead, "prostate_or_uterus", 50},
                                     UsualRelation{"liver", kToHead, "rectum", 60},
                                     UsualRelation{"colon", kToHead, "prostate", 10},
                                     UsualRelation{"urinary_bladder", kToHead, "prostate", 0},
                                     UsualRelation{"adrenal_gland_left", kToHead, "kidney_left", -10},
                                     UsualRelation{"adrenal_gland_right", kToHead, "kidney_right", -10},
                                     UsualRelation{"adrenal_gland_left", kToHead, "urinary_bladder", 60},
                                     UsualRelation{"adrenal_gland_right", kToHead, "urinary_bladder", 60},
                                     UsualRelation{"liver", kToHead, "kidney_right", -20},
                                     UsualRelation{"spleen", kToHead, "kidney_left", -10},
                                     UsualRelation{"esophagus", kToHead, "pancreas", 20},
                                     UsualRelation{"esophagus", kToHead, "kidney_left", 20},
                                     UsualRelation{"esophagus", kToHead, "gallbladder", 20},
                                     UsualRelation{"esophagus", kToHead, "stomach", 0},
                                     UsualRelation{"esophagus", kToHead, "duodenum", 30},
                                     UsualRelation{"heart", kToHead, "liver", 20},
                                     UsualRelation{"heart", kToHead, "stomach", 20},
                                     UsualRelation{"lungs", kToHead, "liver", 20},
                                     UsualRelation{"lungs", kToHead, "kidneys", 40},
                                     UsualRelation{"brain", kToHead, "lungs", 100},
                                     UsualRelation{"brain", kToHead, "liver", 150},
                                     UsualRelation{"kidneys", kToBack, "liver", -10},
                                     UsualRelation{"lung_lower_lobe_left", kToHead, "kidney_left", 30},
                                     UsualRelation{"lung_lower_lobe_right", kToHead, "kidney_right", 30},
                                     UsualRelation{"trachea", kToHead, "stomach", 60},
                                     UsualRelation{"thyroid_gland", kToHead, "liver", 100},
                                     UsualRelation{"thyroid_gland", kToHead, "heart", 40},
                                     UsualRelation{"liver", kToHead, "femur_left", 80},
                                     UsualRelation{"liver", kToHead, "femur_right", 80},
                                     UsualRelation{"liver", kToHead, "sacrum", 40}};

constexpr std::array kUsualDistances{UsualDistance{"liver_tumor", "liver", 0, 140},
                                     UsualDistance{"pancreas_tumor", "pancreas", 0, 100},
                                     UsualDistance{"gallbladder", "liver", 0, 170},
                                     UsualDistance{"prostate", "urinary_bladder", 0, 110},
                                     UsualDistance{"kidney_cyst_left", "kidney_left", 0, 120},
                                     UsualDistance{"kidney_cyst_right", "kidney_right", 0, 120},
                                     UsualDistance{"adrenal_gland_left", "kidney_left", 0, 140},
                                     UsualDistance{"adrenal_gland_right", "kidney_right", 0, 140},
                                     UsualDistance{"kidney_right", "liver", 35, 250},
                                     UsualDistance{"kidney_left", "spleen", 20, 250},
                                     UsualDistance{"kidney_right", "spleen", 50, 350}};

bool starts_with_any(std::string_view name, std::span<const std::string_view> stems) {
  return std::ranges::any_of(stems, [&](std::string_view stem) { return name.starts_with(stem); });
}

}  // namespace

const UsualHu* usual_hu(std::string_view name, std::string_view tissue) {
  const auto* found = std::ranges::find(kUsualHus, name, &UsualHu::name);
  if (found == kUsualHus.end()) found = std::ranges::find(kUsualHus, tissue, &UsualHu::name);
  return found == kUsualHus.end() ? nullptr : &*found;
}

const UsualSize* usual_size(std::string_view name, bool is_vertebra) {
  if (is_vertebra && name != "sacrum") return &kUsualVertebra;
  const auto* found = std::ranges::find(kUsualSizes, name, &UsualSize::name);
  return found == kUsualSizes.end() ? nullptr : &*found;
}

std::vector<UsualSide> usual_sides(std::string_view name, bool is_vertebra) {
  std::vector<UsualSide> sides;
  if (is_vertebra) return {{0, -60, 60}, {1, -15, kAnywhere_mm}};
  for (const NamedSide& row : kUsualSides)
    if (row.name == name) sides.push_back(row.side);
  const bool is_left = name.find("_left") != std::string_view::npos,
             is_right = name.find("_right") != std::string_view::npos;
  if (is_left == is_right || starts_with_any(name, kNearMiddle)) return sides;
  const double least_mm = starts_with_any(name, kFarFromMiddle) ? 15.0 : 0.0;
  sides.push_back(is_left ? UsualSide{0, least_mm, kAnywhere_mm} : UsualSide{0, -kAnywhere_mm, -least_mm});
  return sides;
}

std::span<const UsualRelation> usual_relations() {
  return kUsualRelations;
}

std::span<const UsualDistance> usual_distances() {
  return kUsualDistances;
}

}  // namespace trocar::patient_builder::detail
