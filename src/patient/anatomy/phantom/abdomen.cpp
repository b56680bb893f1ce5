#include "anatomy/phantom/abdomen.h"

namespace trocar::anatomy::phantom {

Result<BiopsyPlan> build_abdomen(Anatomy& anatomy) {
  add_trunk(anatomy);
  add_thorax(anatomy);
  add_bowel(anatomy);
  add_stomach(anatomy);
  add_spleen(anatomy);
  add_pancreas(anatomy);
  add_back_muscles(anatomy);
  add_kidneys(anatomy);
  add_liver(anatomy);
  add_great_vessels(anatomy);
  add_skeleton(anatomy);
  TROCAR_TRY(BiopsyPlan plan, plan_biopsy(anatomy));
  add_liver_vessels(anatomy, plan);
  add_lesions(anatomy, plan);
  TROCAR_TRY_STATUS(anatomy.check_labels());
  return plan;
}

}  // namespace trocar::anatomy::phantom
