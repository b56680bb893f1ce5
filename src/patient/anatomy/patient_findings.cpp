#include "anatomy/patient_findings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "anatomy/plausibility/judge_anatomy.h"
#include "anatomy/repair/repair_segmentation.h"
#include "anatomy/tissue/hounsfield.h"

namespace trocar::anatomy {

std::vector<Finding> patient_findings(const VirtualPatient& patient, const std::vector<LabelStatistics>& statistics) {
  constexpr double kCoarse_mm = 2.5;
  std::vector<Finding> findings;
  const Vec3& spacing = patient.ct.geometry.spacing_mm;
  if (spacing.maxCoeff() > kCoarse_mm)
    findings.push_back({fmt::format("voxels of {:.2f} x {:.2f} x {:.2f} mm: thin structures can be missing",
                                    spacing.x(), spacing.y(), spacing.z()),
                        {},
                        {}});
  for (Finding& finding : find_implausible_hu(patient, statistics)) findings.push_back(std::move(finding));
  std::vector<std::string> cut_off;
  for (const LabelStatistics& s : statistics) {
    const Label* label = patient.label_table.find(s.id);
    if (label == nullptr) continue;
    if (s.voxels == 0) findings.push_back({label->name + " is in the label table but has no voxels", label->name, {}});
    // Fat and muscle extend to every border of a scan; an organ that does is cut off.
    const bool is_filling = label->tissue == "adipose" || label->tissue == "muscle";
    if (s.touches_border && !is_filling && !label->is_derived) cut_off.push_back(label->name);
  }
  if (!cut_off.empty())
    findings.push_back({fmt::format("cut off by the edge of the scan: {}", fmt::join(cut_off, ", ")), {}, {}});
  return findings;
}

std::vector<Finding> all_patient_findings(const VirtualPatient& patient,
                                          const std::vector<LabelStatistics>& statistics) {
  std::vector<Finding> findings = patient_findings(patient, statistics);
  for (Finding& finding : segmentation_findings(patient)) findings.push_back(std::move(finding));
  for (const AnatomyFinding& finding : judge_anatomy(patient))
    if (finding.name != kHu && !is_confirmed(patient.provenance, finding.name))  // HU stand above, a line each
      findings.push_back({fmt::format("{}: {}", finding.name, finding.text), {}, {}});
  return findings;
}

}  // namespace trocar::anatomy
