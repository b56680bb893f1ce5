#include "anatomy/phantom/torso_patient.h"

#include <fmt/format.h>

#include "anatomy/phantom/biopsy.h"
#include "anatomy/phantom/expert_paths.h"
#include "anatomy/phantom/free_fluid.h"
#include "anatomy/phantom/landmarks.h"
#include "anatomy/phantom/liver_segment.h"

namespace trocar::anatomy::phantom {

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

}  // namespace trocar::anatomy::phantom
