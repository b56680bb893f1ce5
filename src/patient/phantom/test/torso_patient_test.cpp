#include "phantom/torso_patient.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "anatomy/testing/shipped_structures.h"
#include "core/files/folders.h"
#include "phantom/consistency.h"
#include "phantom/liver.h"
#include "phantom/phantom.h"

namespace trocar::phantom {
namespace {

using trocar::testing::shipped_structures;

std::vector<CaseDescription> shipped_cases() {
  return load_cases(data_dir() / kCasesFile).value_or(std::vector<CaseDescription>{});
}

std::vector<std::string> case_names() {
  std::vector<std::string> names;
  for (const CaseDescription& description : shipped_cases()) names.push_back(description.name);
  return names;
}

/// The anatomy of a named case, without voxels.
struct BuiltCase {
  explicit BuiltCase(const CaseDescription& description_) : description(description_) {
    AbdomenData data = load_abdomen_data(data_dir() / kAbdomenFile).value();
    const Box box = torso_box(data, description.body, description.seed);
    anatomy = std::make_unique<Anatomy>(description.seed, std::move(data), shipped_structures(), description.body, box);
    anatomy->posture = description.posture;
    plan = build_torso(*anatomy, description);
  }

  Place place_at(const Vec3& p_P) const { return anatomy->torso.at(p_P.cast<float>() / anatomy->scale()); }
  const anatomy::Label* label_at(const Vec3& p_P) const {
    return anatomy->label_table.find(anatomy->label_at(place_at(p_P)));
  }

  CaseDescription description;
  std::unique_ptr<Anatomy> anatomy;
  Result<TorsoPlan> plan = TorsoPlan{};
};

const BuiltCase& built(const std::string& name) {
  static std::map<std::string, std::unique_ptr<BuiltCase>> all;
  auto& found = all[name];
  if (!found)
    for (const CaseDescription& description : shipped_cases())
      if (description.name == name) found = std::make_unique<BuiltCase>(description);
  return *found;
}

/// Name of the bone nearest to a point: spheres of growing radius are searched in all directions.
std::string nearest_bone_of(const BuiltCase& the_case, const Vec3& p_P) {
  constexpr int kDirections = 300;
  constexpr double kGolden = 2.399963229728653;
  for (double radius = 3.0; radius < 90.0; radius += 1.5)
    for (int n = 0; n < kDirections; ++n) {
      const double z = 1.0 - (2.0 * n + 1.0) / kDirections;
      const double r = std::sqrt(1.0 - z * z);
      const Vec3 way(r * std::cos(kGolden * n), r * std::sin(kGolden * n), z);
      const anatomy::Label* label = the_case.label_at(p_P + radius * way);
      if (label != nullptr && label->tissue == "bone") return label->name;
    }
  return {};
}

class NamedCase : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { ASSERT_TRUE(case_.plan) << case_.plan.error().text(); }
  const BuiltCase& case_ = built(GetParam());
};

TEST_P(NamedCase, ExpertPathsReachTheirTargetsAndAvoidRisks) {
  const std::map<std::string, std::string> targets{{"liver-biopsy", "liver_lesion"},
                                                   {"lumbar-puncture", "csf"},
                                                   {"ascites-puncture", "ascites"},
                                                   {"ptcd", "bile_duct"}};
  const std::set<std::string> risks{"bone",   "cartilage",   "vessel", "bowel", "lung",
                                    "kidney", "gallbladder", "spleen", "organ", "nerve"};
  ASSERT_FALSE(case_.plan->paths.empty());
  for (const anatomy::NeedlePath& path : case_.plan->paths) {
    EXPECT_NEAR(case_.place_at(path.line_P.a).skin, 0.0F, 0.05F) << path.name;
    for (double along = 0.5; along < path.line_P.length_mm(); along += 0.25) {
      const anatomy::Label* label = case_.label_at(path.line_P.a + along * path.line_P.direction());
      ASSERT_NE(label, nullptr) << path.name << " at " << along << " mm";
      EXPECT_FALSE(risks.contains(label->tissue)) << path.name << " at " << along << " mm: " << label->name;
    }
    const anatomy::Label* target = case_.label_at(path.line_P.b);
    ASSERT_NE(target, nullptr) << path.name;
    EXPECT_EQ(target->tissue, targets.at(case_.description.task)) << path.name;
  }
}

TEST_P(NamedCase, LumbarPathsPassTheLigamentsInTheirOrder) {
  if (case_.description.task != "lumbar-puncture") GTEST_SKIP() << "another task";
  for (const anatomy::NeedlePath& path : case_.plan->paths) {
    std::vector<std::string> order;
    for (double along = 0.5; along <= path.line_P.length_mm(); along += 0.1) {
      const std::string name = case_.label_at(path.line_P.a + along * path.line_P.direction())->name;
      if (order.empty() || order.back() != name) order.push_back(name);
    }
    EXPECT_EQ(order.front(), "fat") << path.name;
    const std::vector<std::string> inner{"ligamentum_flavum", "epidural_fat", "dural_sac"};
    ASSERT_GE(order.size(), inner.size()) << path.name;
    EXPECT_TRUE(std::equal(inner.rbegin(), inner.rend(), order.rbegin())) << path.name;
    EXPECT_NE(std::find(order.begin(), order.end(), "interspinous_ligament"), order.end()) << path.name;
  }
}

TEST_P(NamedCase, VenousPlexusLiesBehindTheSac) {
  if (case_.description.task != "lumbar-puncture") GTEST_SKIP() << "another task";
  for (const anatomy::NeedlePath& path : case_.plan->paths) {
    std::vector<std::string> order;
    for (double beyond = 0.0; beyond <= 14.0; beyond += 0.1) {
      const anatomy::Label* const label = case_.label_at(path.line_P.b + beyond * path.line_P.direction());
      const std::string name = label->name.starts_with("vertebrae") ? "vertebrae" : label->name;
      if (label->tissue != "nerve" && (order.empty() || order.back() != name)) order.push_back(name);
    }
    ASSERT_GE(order.size(), 3U) << path.name;
    EXPECT_EQ(order[0], "dural_sac") << path.name;
    EXPECT_EQ(order[1], "epidural_veins") << path.name;
    EXPECT_NE(order[2], "dural_sac") << path.name;
  }
}

TEST_P(NamedCase, TheHilumIsAtTheLiversPortalVein) {
  const auto hilum = std::ranges::find(case_.plan->landmarks, kHilumLandmark, &anatomy::Landmark::name);
  ASSERT_NE(hilum, case_.plan->landmarks.end());
  const Place place = case_.place_at(hilum->p_P);
  EXPECT_LT(std::abs(case_.anatomy->find("liver").distance(place)), 30.0F);
  EXPECT_LT(case_.anatomy->find("portal_vein_and_splenic_vein").distance(place), 15.0F);
}

TEST_P(NamedCase, LandmarksLieOnTheSkinOverTheirBones) {
  const std::map<std::string, std::string> bones{{"spinous process L1", "vertebrae_L1"},
                                                 {"spinous process L2", "vertebrae_L2"},
                                                 {"spinous process L3", "vertebrae_L3"},
                                                 {"spinous process L4", "vertebrae_L4"},
                                                 {"spinous process L5", "vertebrae_L5"},
                                                 {"left iliac crest", "hip_left"},
                                                 {"right iliac crest", "hip_right"},
                                                 {"left anterior superior iliac spine", "hip_left"},
                                                 {"right anterior superior iliac spine", "hip_right"},
                                                 {"left posterior superior iliac spine", "hip_left"},
                                                 {"right posterior superior iliac spine", "hip_right"},
                                                 {"pubic symphysis", "hip"},
                                                 {"xiphoid", "sternum"}};
  std::set<std::string> seen;
  for (const anatomy::Landmark& landmark : case_.plan->landmarks) {
    if (landmark.name == kHilumLandmark) continue;  // inside
    EXPECT_NEAR(case_.place_at(landmark.p_P).skin, 0.0F, 1.6F) << landmark.name;
    const auto bone = bones.find(landmark.name);
    if (bone == bones.end()) continue;
    seen.insert(landmark.name);
    const std::string first = nearest_bone_of(case_, landmark.p_P);
    EXPECT_TRUE(first.starts_with(bone->second)) << landmark.name << " lies over " << first;
  }
  EXPECT_EQ(seen.size(), bones.size());
}

TEST_P(NamedCase, VertebraeFollowEachOtherDownwards) {
  std::vector<double> heights;
  for (const std::string vertebra : {"T12", "L1", "L2", "L3", "L4", "L5"})
    for (const anatomy::Landmark& landmark : case_.plan->landmarks)
      if (landmark.name == "spinous process " + vertebra) heights.push_back(landmark.p_P.z());
  ASSERT_EQ(heights.size(), 6U);
  for (std::size_t n = 1; n < heights.size(); ++n) {
    EXPECT_GT(heights[n - 1] - heights[n], 15.0) << n;
    EXPECT_LT(heights[n - 1] - heights[n], 48.0) << n;
  }
}

INSTANTIATE_TEST_SUITE_P(All, NamedCase, ::testing::ValuesIn(case_names()), [](const auto& named) {
  std::string name = named.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(NamedCases, AreFivePerTaskInOrderOfDifficulty) {
  std::map<std::string, std::vector<int>> difficulties;
  for (const CaseDescription& description : shipped_cases()) {
    difficulties[description.task].push_back(description.difficulty);
    for (const std::string* text : {&description.indication, &description.coagulation, &description.allergies})
      EXPECT_FALSE(text->empty()) << description.name;
  }
  ASSERT_EQ(difficulties.size(), 4U);
  for (const auto& [task, levels] : difficulties) EXPECT_EQ(levels, (std::vector<int>{1, 2, 3, 4, 5})) << task;
}

// Volumes of the whole structures in ml. Liver: mean 1.5 l, 1.0 to 2.3 l in adults (Henderson et al., J Pathol 118:25,
// 1976, and CT volumetry); spleen 50 to 410 (Prassopoulos et al., Eur Radiol 7:246, 1997: mean 215); kidney 90 to 260
// (Cheong et al., CJASN 2:38, 2007, MRI: 150 to 200, larger in tall men); gallbladder 12 to 130 (fasting 20 to 50,
// distended more); lumbar vertebra 30 to 95 with its arch.
TEST(NamedCases, ReferralHoldsForAllSeeds) {
  // Other seeds place other lesions, and smaller ones where there is no room.
  for (const CaseDescription& description : shipped_cases())
    for (const char* word : {" mm", "lobe", "segment"})
      for (const std::string& text : {description.description, description.indication})
        EXPECT_EQ(text.find(word), std::string::npos) << description.name << ": " << text;
}

TEST(NamedCases, HaveOrgansOfPublishedSize) {
  const std::map<std::string, std::pair<double, double>> limits{
      {"liver", {950.0, 2300.0}},         {"spleen", {50.0, 410.0}},      {"kidney_left", {90.0, 260.0}},
      {"kidney_right", {90.0, 260.0}},    {"gallbladder", {12.0, 130.0}}, {"vertebrae_L3", {30.0, 95.0}},
      {"urinary_bladder", {40.0, 400.0}}, {"sacrum", {110.0, 320.0}},     {"dural_sac", {25.0, 90.0}}};
  for (const std::string name : {"lumbar-5", "ascites-1", "ptcd-5", "biopsy-1"}) {
    const auto patient = generate_phantom(name, 1, {{0, 0, 0}, 2.0});
    ASSERT_TRUE(patient) << patient.error().text();
    std::map<std::string, double> volumes;
    const double voxel_ml = patient->labels.geometry.voxel_volume_mm3() / 1000.0;
    for (const std::uint8_t id : patient->labels.voxels)
      if (const anatomy::Label* label = patient->label_table.find(id)) volumes[label->name] += voxel_ml;
    for (const auto& [structure, range] : limits) {
      EXPECT_GT(volumes[structure], range.first) << name << ": " << structure;
      EXPECT_LT(volumes[structure], range.second) << name << ": " << structure;
    }
    for (const anatomy::Label& label : patient->label_table.labels)
      EXPECT_GT(volumes[label.name], 0.0) << name << ": " << label.name;
    const std::vector<std::string> contradictions = find_contradictions(*patient);
    EXPECT_TRUE(contradictions.empty()) << name << ": " << (contradictions.empty() ? "" : contradictions.front());
    if (name == std::string("ascites-1")) {
      EXPECT_NEAR(volumes["ascites"], 6000.0, 600.0);
    }
  }
}

// Depth of the dural sac below the skin in the midline at L3/4: about 45 to 60 mm at a body mass index of 20 to 25 and
// 60 to 90 above 33 (skin to epidural space: Ravi et al., Saudi J Anaesth 5:291, 2011, and formulas by weight);
// thickness of the ligamentum flavum 3 to 5 mm; sac behind it within 7 mm.
TEST(NamedCases, HaveLumbarDistancesOfPublishedSize) {
  const std::map<std::string, std::pair<double, double>> to_sac{{"lumbar-1", {36.0, 60.0}}, {"lumbar-4", {52.0, 90.0}}};
  for (const auto& [name, range] : to_sac) {
    const BuiltCase& the_case = built(name);
    const anatomy::NeedlePath& path = the_case.plan->paths.front();
    std::map<std::string, double> length_mm;
    double sac_mm = -1.0;
    for (double along = 0.5; along <= path.line_P.length_mm(); along += 0.1) {
      const std::string label = the_case.label_at(path.line_P.a + along * path.line_P.direction())->name;
      length_mm[label] += 0.1;
      if (label == "dural_sac" && sac_mm < 0.0) sac_mm = along;
    }
    EXPECT_GT(sac_mm, range.first) << name;
    EXPECT_LT(sac_mm, range.second) << name;
    EXPECT_GT(length_mm["ligamentum_flavum"], 2.5) << name;
    EXPECT_LT(length_mm["ligamentum_flavum"], 6.5) << name;
    EXPECT_GT(length_mm["epidural_fat"], 2.0) << name;
    EXPECT_LT(length_mm["epidural_fat"], 7.5) << name;
  }
}

// Shares of the whole liver: right lobe (V to VIII) 55 to 75 %, lateral left (II, III) 10 to 25 %, IV 8 to 24 %,
// caudate below 6 % (CT volumetry of healthy livers: Leelaudomlipi et al., Liver Transpl 8:1136, 2002; Abdalla et al.,
// Surgery 135:404, 2004).
TEST(LiverSegment, HasSegmentsOfPublishedSize) {
  const BuiltCase& the_case = built("biopsy-2");
  const Structure& liver = the_case.anatomy->find("liver");
  std::map<std::string_view, double> count;
  double all = 0.0;
  for (float z = -110.0F; z < 112.0F; z += 5.0F)
    for (float y = -140.0F; y < 115.0F; y += 5.0F)
      for (float x = -170.0F; x < 90.0F; x += 5.0F) {
        const Place place = the_case.anatomy->torso.at(Vec3f(x, y, z));
        if (liver.distance(place) >= 0.0F) continue;
        count[liver_segment(*the_case.anatomy, place)] += 1.0;
        all += 1.0;
      }
  EXPECT_EQ(count.size(), 8U);
  const double right = (count["V"] + count["VI"] + count["VII"] + count["VIII"]) / all;
  EXPECT_GT(right, 0.55);
  EXPECT_LT(right, 0.75);
  EXPECT_GT((count["II"] + count["III"]) / all, 0.10);
  EXPECT_LT((count["II"] + count["III"]) / all, 0.25);
  EXPECT_GT(count["IV"] / all, 0.08);
  EXPECT_LT(count["IV"] / all, 0.24);
  EXPECT_LT(count["I"] / all, 0.06);
  for (const std::string_view segment : {"V", "VI", "VII", "VIII"}) EXPECT_GT(count[segment] / all, 0.06) << segment;
}

TEST(FreeFluid, FillsTheLowestSpaceForThePosture) {
  CaseDescription description = shipped_cases().at(8);
  ASSERT_EQ(description.task, "ascites-puncture");
  description.body.ascites_ml = 1200.0;
  const auto middle_of_fluid = [&](anatomy::Posture posture) -> Vec3 {
    description.posture = posture;
    const BuiltCase made(description);
    const Vec3 low = made.anatomy->torso.box().low.cast<double>(), high = made.anatomy->torso.box().high.cast<double>();
    const std::uint8_t fluid = made.anatomy->label_table.find("ascites")->id;
    Vec3 sum = Vec3::Zero();
    double count = 0.0;
    for (double z = low.z(); z < high.z(); z += 9.0)
      for (double y = low.y(); y < high.y(); y += 9.0)
        for (double x = low.x(); x < high.x(); x += 9.0)
          if (made.anatomy->label_at(made.anatomy->torso.at(Vec3(x, y, z).cast<float>())) == fluid) {
            sum += Vec3(x, y, z);
            count += 1.0;
          }
    return sum / count;
  };
  const Vec3 supine = middle_of_fluid(anatomy::Posture::kSupine);
  const Vec3 left = middle_of_fluid(anatomy::Posture::kLeftLateral);
  const Vec3 prone = middle_of_fluid(anatomy::Posture::kProne);
  EXPECT_GT(left.x(), supine.x() + 25.0);
  EXPECT_LT(prone.y(), supine.y() - 15.0);
  EXPECT_NEAR(supine.x(), 0.0, 25.0);
}

TEST(SpineCurve, StraightenInvertsBend) {
  const AbdomenData data = load_abdomen_data(data_dir() / kAbdomenFile).value();
  const SpineCurve spine(Vec3f(0.0F, 23.0F, -61.0F), data.spine.inclinations, {0.4F, 0.4F});
  for (const Vec3f& along : {Vec3f(0, 0, -61), Vec3f(20, 40, -95), Vec3f(-30, -15, 50), Vec3f(5, 60, -180)})
    EXPECT_LT((spine.straighten(spine.bend(along)) - along).norm(), 0.05F) << along.transpose();
  EXPECT_LT((spine.bend(Vec3f(0, 0, -61)) - Vec3f(spine.bend(Vec3f(0, 0, -61)).x(), 23.0F, -61.0F)).norm(), 0.01F);
}

TEST(SpineCurve, OpensTheSpacesBehindWhenItIsFlexed) {
  const AbdomenData data = load_abdomen_data(data_dir() / kAbdomenFile).value();
  const auto tips_apart = [&](float flexion) {
    const SpineCurve spine(Vec3f(0.0F, 23.0F, -61.0F), data.spine.inclinations, {flexion, 0.0F});
    return (spine.bend(Vec3f(0, 55, -95)) - spine.bend(Vec3f(0, 55, -130))).norm();
  };
  EXPECT_GT(tips_apart(1.0F), tips_apart(0.0F) + 2.0F);
}

TEST(SpineCurve, HasTheCobbAngleOfItsScoliosis) {
  const AbdomenData data = load_abdomen_data(data_dir() / kAbdomenFile).value();
  const float cobb = 0.4F;
  const SpineCurve spine(Vec3f(0.0F, 23.0F, -61.0F), data.spine.inclinations, {0.0F, cobb});
  float most = -10.0F, least = 10.0F;
  for (float s = -150.0F; s < 110.0F; s += 2.0F) {
    const Vec3f way = spine.bend(Vec3f(0, 0, s + 1.0F)) - spine.bend(Vec3f(0, 0, s - 1.0F));
    const float angle = std::atan2(way.x(), way.z());
    most = std::max(most, angle);
    least = std::min(least, angle);
  }
  EXPECT_NEAR(most - least, cobb, 0.03F);
  EXPECT_GT(spine.bend(Vec3f(0, 0, -19)).x(), spine.bend(Vec3f(0, 0, 120)).x());  // convex to the left
}

}  // namespace
}  // namespace trocar::phantom
