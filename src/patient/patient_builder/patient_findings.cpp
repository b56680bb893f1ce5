#include "patient_builder/patient_findings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "anatomy/tissue/hounsfield.h"
#include "patient_builder/plausibility/judge_anatomy.h"
#include "patient_builder/repair/repair_segmentation.h"

namespace trocar::patient_builder {

std::vector<anatomy::Finding> patient_findings(const anatomy::VirtualPatient& patient,
                                               const std::vector<anatomy::LabelStatistics>& statistics) {
  constexpr double kCoarse_mm = 2.5;
  std::vector<anatomy::Finding> findings;
  const Vec3& spacing = patient.ct.geometry.spacing_mm;
  if (spacing.maxCoeff() > kCoarse_mm)
    findings.push_back({fmt::format("voxels of {:.2f} x {:.2f} x {:.2f} mm: thin structures can be missing",
                                    spacing.x(), spacing.y(), spacing.z()),
                        {},
                        {}});
  for (anatomy::Finding& finding : anatomy::find_implausible_hu(patient, statistics))
    findings.push_back(std::move(finding));
  std::vector<std::string> cut_off;
  for (const anatomy::LabelStatistics& s : statistics) {
    const anatomy::Label* label = patient.label_table.find(s.id);
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

std::vector<anatomy::Finding> all_patient_findings(const anatomy::VirtualPatient& patient,
                                                   const std::vector<anatomy::LabelStatistics>& statistics) {
  std::vector<anatomy::Finding> findings = patient_findings(patient, statistics);
  for (anatomy::Finding& finding : segmentation_findings(patient)) findings.push_back(std::move(finding));
  for (const AnatomyFinding& finding : judge_anatomy(patient))
    if (finding.name != kHu && !is_confirmed(patient.provenance, finding.name))  // HU stand above, a line each
      findings.push_back({fmt::format("{}: {}", finding.name, finding.text), {}, {}});
  return findings;
}

}  // namespace trocar::patient_builder
