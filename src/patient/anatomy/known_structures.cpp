#include <algorithm>
#include <array>
#include <cctype>
#include <numeric>

#include "anatomy/label_table.h"

namespace trocar::anatomy {
namespace {

// Priority of masks that claim the same voxel: structures inside or on top of another come later.
constexpr int kFill = 10;  // fat, other soft tissue
constexpr int kMuscle = 20;
constexpr int kHollow = 30;      // lung, bowel, fluid
constexpr int kParenchyma = 40;  // solid organs
constexpr int kBone = 50;
constexpr int kCanal = 60;  // content of the vertebral canal
constexpr int kSac = 62;    // the dural sac in it
constexpr int kCord = 64;   // the spinal cord in the sac
constexpr int kVein = 70;   // vessels inside an organ
constexpr int kArtery = 75;
constexpr int kDuct = 77;  // bile ducts next to them
constexpr int kCyst = 80;
constexpr int kLesion = 90;  // a tumour, above its organ

// Colours as in anatomical plates: arteries red, veins blue, portal vein violet, bone ivory, fat yellow, bile green.
constexpr volume::Rgb kLiverBrown{150, 68, 52};
constexpr volume::Rgb kLesionGreen{158, 205, 58};
constexpr volume::Rgb kBoneIvory{232, 220, 190};
constexpr volume::Rgb kCartilageBlueGrey{186, 204, 204};
constexpr volume::Rgb kMuscleRed{152, 48, 44};
constexpr volume::Rgb kFatYellow{240, 205, 105};
constexpr volume::Rgb kArteryRed{214, 32, 34};
constexpr volume::Rgb kVeinBlue{52, 92, 190};
constexpr volume::Rgb kPortalViolet{124, 72, 196};
constexpr volume::Rgb kBowelPink{222, 150, 120};
constexpr volume::Rgb kStomachPink{214, 128, 122};
constexpr volume::Rgb kLungRose{232, 176, 180};
constexpr volume::Rgb kKidneyMaroon{134, 50, 42};
constexpr volume::Rgb kSpleenPurple{128, 56, 84};
constexpr volume::Rgb kBileGreen{70, 140, 70};
constexpr volume::Rgb kPancreasOchre{226, 176, 110};
constexpr volume::Rgb kGlandOrange{228, 148, 64};
constexpr volume::Rgb kHeartRed{180, 50, 54};
constexpr volume::Rgb kLigamentSand{206, 186, 150};
constexpr volume::Rgb kFlavumGold{218, 178, 60};
constexpr volume::Rgb kCsfBlue{146, 206, 236};
constexpr volume::Rgb kSerousPearl{214, 200, 206};
constexpr volume::Rgb kNerveYellow{250, 238, 130};
constexpr volume::Rgb kFluidBlue{120, 180, 220};
constexpr volume::Rgb kGasGrey{70, 82, 96};
constexpr volume::Rgb kSoftRose{196, 136, 116};
constexpr volume::Rgb kSkinTone{228, 184, 154};

/// A row: the name without case, separators and side. A trailing '#' matches any number of digits, '%#' the letter and
/// digits of a spine region, '*' anything.
struct Row {
  std::string_view pattern;
  KnownStructure known;
};

constexpr Row kRows[] = {
    // Lesions first: "livertumor" is not a liver.
    {"livertumor#", {"liver_lesion", kLesionGreen, kLesion}},
    {"livertumors#", {"liver_lesion", kLesionGreen, kLesion}},
    {"livertumour#", {"liver_lesion", kLesionGreen, kLesion}},
    {"livertumours#", {"liver_lesion", kLesionGreen, kLesion}},
    {"liverlesion#", {"liver_lesion", kLesionGreen, kLesion}},
    {"liverlesions#", {"liver_lesion", kLesionGreen, kLesion}},
    {"livermetastasis#", {"liver_lesion", kLesionGreen, kLesion}},
    {"hepatictumor#", {"liver_lesion", kLesionGreen, kLesion}},
    {"hepaticlesion#", {"liver_lesion", kLesionGreen, kLesion}},
    {"metastasectomie#", {"liver_lesion", kLesionGreen, kLesion}},
    {"lesion#", {"liver_lesion", kLesionGreen, kLesion}},
    {"tumor#", {"liver_lesion", kLesionGreen, kLesion}},
    {"tumour#", {"liver_lesion", kLesionGreen, kLesion}},
    {"liverkyst#", {"fluid", kFluidBlue, kCyst}},
    {"livercyst#", {"fluid", kFluidBlue, kCyst}},
    {"kidneycyst#", {"fluid", kFluidBlue, kCyst}},
    {"cyst#", {"fluid", kFluidBlue, kCyst}},

    {"liver", {"liver", kLiverBrown, kParenchyma}},
    {"liversegment#", {"liver", kLiverBrown, kParenchyma}},
    {"spleen", {"spleen", kSpleenPurple, kParenchyma}},
    {"kidney", {"kidney", kKidneyMaroon, kParenchyma}},
    {"kidneys", {"kidney", kKidneyMaroon, kParenchyma}},
    {"gallbladder", {"gallbladder", kBileGreen, kParenchyma}},
    {"pancreas", {"organ", kPancreasOchre, kParenchyma}},
    {"adrenalgland", {"organ", kGlandOrange, kParenchyma}},
    {"adrenalglands", {"organ", kGlandOrange, kParenchyma}},
    {"surrenalgland", {"organ", kGlandOrange, kParenchyma}},
    {"surrenalglands", {"organ", kGlandOrange, kParenchyma}},
    {"thyroidgland", {"organ", kGlandOrange, kParenchyma}},
    {"thyroid", {"organ", kGlandOrange, kParenchyma}},
    {"prostate", {"organ", kGlandOrange, kParenchyma}},
    {"uterus", {"organ", kStomachPink, kParenchyma}},
    {"heart*", {"organ", kHeartRed, kParenchyma}},
    {"atrialappendage", {"organ", kHeartRed, kParenchyma}},

    {"stomach", {"bowel", kStomachPink, kHollow}},
    {"duodenum", {"bowel", kBowelPink, kHollow}},
    {"esophagus", {"bowel", kBowelPink, kHollow}},
    {"oesophagus", {"bowel", kBowelPink, kHollow}},
    {"smallbowel", {"bowel", kBowelPink, kHollow}},
    {"smallintestin", {"bowel", kBowelPink, kHollow}},
    {"smallintestine", {"bowel", kBowelPink, kHollow}},
    {"colon", {"bowel", kBowelPink, kHollow}},
    {"bowel", {"bowel", kBowelPink, kHollow}},
    {"rectum", {"bowel", kBowelPink, kHollow}},
    {"urinarybladder", {"fluid", kFluidBlue, kHollow}},
    {"bladder", {"fluid", kFluidBlue, kHollow}},
    {"ascites", {"ascites", kFluidBlue, kFill}},
    {"peritoneum", {"peritoneum", kSerousPearl, kFill}},
    {"pleuraleffusion", {"fluid", kFluidBlue, kHollow}},
    {"lung", {"lung", kLungRose, kHollow}},
    {"lungs", {"lung", kLungRose, kHollow}},
    {"lungbase", {"lung", kLungRose, kHollow}},
    {"lungupperlobe", {"lung", kLungRose, kHollow}},
    {"lungmiddlelobe", {"lung", kLungRose, kHollow}},
    {"lunglowerlobe", {"lung", kLungRose, kHollow}},
    {"trachea", {"lung", kLungRose, kHollow}},

    {"aorta", {"vessel", kArteryRed, kArtery}},
    {"artery", {"vessel", kArteryRed, kArtery}},
    {"arteries", {"vessel", kArteryRed, kArtery}},
    {"hepaticartery", {"vessel", kArteryRed, kArtery}},
    {"pulmonaryartery", {"vessel", kArteryRed, kArtery}},
    {"brachiocephalictrunk", {"vessel", kArteryRed, kArtery}},
    {"subclavianartery", {"vessel", kArteryRed, kArtery}},
    {"commoncarotidartery", {"vessel", kArteryRed, kArtery}},
    {"iliacartery", {"vessel", kArteryRed, kArtery}},
    {"portalvein#", {"vessel", kPortalViolet, kVein}},
    {"portalveinandsplenicvein", {"vessel", kPortalViolet, kVein}},
    {"splenicvein", {"vessel", kPortalViolet, kVein}},
    {"hepaticvein#", {"vessel", kVeinBlue, kVein}},
    {"hepaticveins", {"vessel", kVeinBlue, kVein}},
    {"hepaticvessels", {"vessel", kVeinBlue, kVein}},
    {"livervessels", {"vessel", kVeinBlue, kVein}},
    {"venoussystem", {"vessel", kVeinBlue, kVein}},
    {"vein", {"vessel", kVeinBlue, kVein}},
    {"veins", {"vessel", kVeinBlue, kVein}},
    {"venacava", {"vessel", kVeinBlue, kVein}},
    {"inferiorvenacava", {"vessel", kVeinBlue, kVein}},
    {"superiorvenacava", {"vessel", kVeinBlue, kVein}},
    {"pulmonaryvein", {"vessel", kVeinBlue, kVein}},
    {"brachiocephalicvein", {"vessel", kVeinBlue, kVein}},
    {"iliacvena", {"vessel", kVeinBlue, kVein}},
    {"iliacvein", {"vessel", kVeinBlue, kVein}},
    {"biliarysystem", {"bile_duct", kBileGreen, kDuct}},
    {"biliarytree", {"bile_duct", kBileGreen, kDuct}},
    {"bileduct#", {"bile_duct", kBileGreen, kDuct}},
    {"bileducts", {"bile_duct", kBileGreen, kDuct}},
    {"commonbileduct", {"bile_duct", kBileGreen, kDuct}},
    {"hepaticduct", {"bile_duct", kBileGreen, kDuct}},

    {"bone", {"bone", kBoneIvory, kBone}},
    {"bones", {"bone", kBoneIvory, kBone}},
    {"boneother", {"bone", kBoneIvory, kBone}},
    {"rib#", {"bone", kBoneIvory, kBone}},
    {"ribs", {"bone", kBoneIvory, kBone}},
    {"sternum", {"bone", kBoneIvory, kBone}},
    {"spine", {"bone", kBoneIvory, kBone}},
    {"vertebraebody", {"bone", kBoneIvory, kBone}},
    {"vertebrae", {"bone", kBoneIvory, kBone}},
    {"vertebra#", {"bone", kBoneIvory, kBone}},
    {"vertebrae%#", {"bone", kBoneIvory, kBone}},
    {"vertebra%#", {"bone", kBoneIvory, kBone}},
    {"sacrum", {"bone", kBoneIvory, kBone}},
    {"humerus", {"bone", kBoneIvory, kBone}},
    {"scapula", {"bone", kBoneIvory, kBone}},
    {"clavicula", {"bone", kBoneIvory, kBone}},
    {"femur", {"bone", kBoneIvory, kBone}},
    {"hip", {"bone", kBoneIvory, kBone}},
    {"pelvis", {"bone", kBoneIvory, kBone}},
    {"skull", {"bone", kBoneIvory, kBone}},
    {"costalcartilages", {"cartilage", kCartilageBlueGrey, kBone}},
    {"costalcartilage#", {"cartilage", kCartilageBlueGrey, kBone}},
    {"cartilage#", {"cartilage", kCartilageBlueGrey, kBone}},
    {"intervertebraldiscs", {"cartilage", kCartilageBlueGrey, kBone}},
    {"intervertebraldisc#", {"cartilage", kCartilageBlueGrey, kBone}},
    {"disc#", {"cartilage", kCartilageBlueGrey, kBone}},
    {"discs", {"cartilage", kCartilageBlueGrey, kBone}},
    {"spinalcord", {"nerve", kNerveYellow, kCord}},
    {"spinalcanal", {"csf", kCsfBlue, kCanal}},
    {"csf", {"csf", kCsfBlue, kSac}},
    {"cerebrospinalfluid", {"csf", kCsfBlue, kSac}},
    {"dura", {"csf", kCsfBlue, kSac}},
    {"duralsac", {"csf", kCsfBlue, kSac}},
    {"thecalsac", {"csf", kCsfBlue, kSac}},
    {"epiduralfat", {"adipose", kFatYellow, kCanal}},
    {"epiduralspace", {"adipose", kFatYellow, kCanal}},

    {"ligamentumflavum", {"ligamentum_flavum", kFlavumGold, kCanal}},
    {"ligamentaflava", {"ligamentum_flavum", kFlavumGold, kCanal}},
    {"supraspinousligament", {"ligament", kLigamentSand, kBone}},
    {"interspinousligament", {"ligament", kLigamentSand, kBone}},
    {"ligament", {"ligament", kLigamentSand, kBone}},
    {"ligaments", {"ligament", kLigamentSand, kBone}},
    {"brain", {"nerve", kNerveYellow, kParenchyma}},

    {"autochthon", {"muscle", kMuscleRed, kMuscle}},
    {"iliopsoas", {"muscle", kMuscleRed, kMuscle}},
    {"psoas", {"muscle", kMuscleRed, kMuscle}},
    {"gluteusmaximus", {"muscle", kMuscleRed, kMuscle}},
    {"gluteusmedius", {"muscle", kMuscleRed, kMuscle}},
    {"gluteusminimus", {"muscle", kMuscleRed, kMuscle}},
    {"diaphragm", {"muscle", kMuscleRed, kMuscle}},
    {"muscle", {"muscle", kMuscleRed, kMuscle}},
    {"muscles", {"muscle", kMuscleRed, kMuscle}},
    {"skeletalmuscle", {"muscle", kMuscleRed, kMuscle}},
    {"fat", {"adipose", kFatYellow, kFill}},
    {"adipose", {"adipose", kFatYellow, kFill}},
    {"subcutaneousfat", {"adipose", kFatYellow, kFill}},
    {"visceralfat", {"adipose", kFatYellow, kFill}},
    {"torsofat", {"adipose", kFatYellow, kFill}},
    {"softtissue", {"soft_tissue", kSoftRose, kFill}},
    {"gas", {"gas", kGasGrey, kFill}},

    {"skin", {"skin", kSkinTone, 0}},
    {"body", {"skin", kSkinTone, 0}},
    {"bodytrunc", {"skin", kSkinTone, 0}},
};

/// Lower case letters and digits only.
std::string plain(std::string_view name) {
  std::string text;
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u)) text += static_cast<char>(std::tolower(u));
  }
  return text;
}

std::string without_side(std::string text) {
  for (const std::string_view side : {"left", "right"}) {
    if (const auto at = text.find(side); at != std::string::npos) text.erase(at, side.size());
  }
  return text;
}

bool is_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool matches(std::string_view pattern, std::string_view key) {
  const auto stem_end = pattern.find_first_of("%#*");
  const std::string_view stem = pattern.substr(0, stem_end);
  if (!key.starts_with(stem)) return false;
  if (stem_end == std::string_view::npos) return key.size() == stem.size();
  std::string_view rest = key.substr(stem.size());
  if (pattern[stem_end] == '*') return true;
  if (pattern[stem_end] == '%') {
    if (rest.empty() || std::string_view("ctls").find(rest.front()) == std::string_view::npos) return false;
    rest.remove_prefix(1);
  }
  return is_digits(rest);
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

std::optional<KnownStructure> find_known_structure(std::string_view name) {
  const std::string key = without_side(plain(name));
  for (const Row& row : kRows) {
    if (matches(row.pattern, key)) return row.known;
  }
  return std::nullopt;
}

bool is_background_name(std::string_view name) {
  constexpr std::array<std::string_view, 13> kBackground = {
      "background", "air",  "clearlabel", "clear",      "exterior",   "outside",        "none",
      "empty",      "null", "unlabeled",  "unlabelled", "unassigned", "backgroundlabel"};
  return std::find(kBackground.begin(), kBackground.end(), plain(name)) != kBackground.end();
}

std::vector<std::string> similar_structure_names(std::string_view name, std::size_t count) {
  const std::string wanted = plain(name);
  std::vector<std::pair<std::size_t, std::string>> candidates;
  const auto consider = [&](std::string_view known) {
    const std::string spelled = plain(known);
    const std::size_t distance = edit_distance(wanted, spelled);
    // With more changes it is another word, not a misspelling: "my_roi" is not "thyroid".
    const std::size_t allowed = std::max<std::size_t>(1, (std::max(wanted.size(), spelled.size()) + 1) / 4);
    if (distance <= allowed) candidates.emplace_back(distance, known);
  };
  for (int number = 1; const auto known = totalsegmentator_name(number); ++number) consider(*known);
  for (const Row& row : kRows) {
    if (row.pattern.find('%') != std::string_view::npos) continue;  // this includes all names of TotalSegmentator
    const std::string_view known = row.pattern.substr(0, row.pattern.find_first_of("#*"));
    const auto spelled = [&](const auto& candidate) { return plain(candidate.second) == known; };
    if (std::none_of(candidates.begin(), candidates.end(), spelled)) consider(known);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> names;
  for (std::size_t n = 0; n < std::min(count, candidates.size()); ++n) names.push_back(candidates[n].second);
  return names;
}

}  // namespace trocar::anatomy
