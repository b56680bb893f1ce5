#include "anatomy/patient_doubts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "anatomy/plausibility/judge_anatomy.h"
#include "anatomy/repair/repair_segmentation.h"
#include "anatomy/tissue/plausible_hu.h"

namespace trocar::anatomy {

std::vector<Finding> find_doubts(const VirtualPatient& patient, const std::vector<LabelStatistics>& statistics) {
  constexpr double kCoarse_mm = 2.5;
  std::vector<Finding> doubts;
  const Vec3& spacing = patient.ct.geometry.spacing_mm;
  if (spacing.maxCoeff() > kCoarse_mm)
    doubts.push_back({fmt::format("voxels of {:.2f} x {:.2f} x {:.2f} mm: thin structures can be missing", spacing.x(),
                                  spacing.y(), spacing.z()),
                      {},
                      {}});
  for (Finding& doubt : find_implausible_hu(patient, statistics)) doubts.push_back(std::move(doubt));
  std::vector<std::string> cut_off;
  for (const LabelStatistics& s : statistics) {
    const Label* label = patient.label_table.find(s.id);
    if (label == nullptr) continue;
    if (s.voxels == 0) doubts.push_back({label->name + " is in the label table but has no voxels", label->name, {}});
    // Fat and muscle extend to every border of a scan; an organ that does is cut off.
    const bool is_filling = label->tissue == "adipose" || label->tissue == "muscle";
    if (s.touches_border && !is_filling && !label->is_derived) cut_off.push_back(label->name);
  }
  if (!cut_off.empty())
    doubts.push_back({fmt::format("cut off by the edge of the scan: {}", fmt::join(cut_off, ", ")), {}, {}});
  return doubts;
}

std::vector<Finding> find_all_doubts(const VirtualPatient& patient, const std::vector<LabelStatistics>& statistics) {
  std::vector<Finding> doubts = find_doubts(patient, statistics);
  for (Finding& doubt : find_segmentation_doubts(patient)) doubts.push_back(std::move(doubt));
  for (const AnatomyFinding& finding : judge_anatomy(patient))
    if (finding.name != kHu && !is_confirmed(patient.provenance, finding.name))  // HU stand above, a line each
      doubts.push_back({fmt::format("{}: {}", finding.name, finding.text), {}, {}});
  return doubts;
}

}  // namespace trocar::anatomy
