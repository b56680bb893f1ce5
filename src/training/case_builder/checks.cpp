#include "case_builder/checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "case_builder/case_draft.h"
#include "case_builder/ultrasound.h"
#include "patient_builder/patient_findings.h"
#include "patient_builder/plausibility/judge_anatomy.h"
#include "tasks/assess_path.h"
#include "volume/sampling.h"

namespace trocar::case_builder {
namespace {

constexpr double kOutside_mm = 2.0;     ///< Outside the skin: more than the edge of a voxel.
constexpr double kShareOutside = 0.02;  ///< Share of a label outside without a warning, as in build_patient.

/// Plausible volumes (ml) of adult organs, with wide limits: half the minimum and twice the maximum of published
/// ranges. [assumed]
struct OrganVolume {
  const char* tissue;
  double least_ml, most_ml;
};
constexpr OrganVolume kOrganVolumes[] = {{"liver", 500.0, 5000.0},
                                         {"spleen", 30.0, 2000.0},
                                         {"kidney", 40.0, 600.0},
                                         {"gallbladder", 1.0, 300.0},
                                         {"liver_lesion", 0.03, 2000.0}};

/// Results of the checks, collected step by step.
class Checks {
 public:
  Checks(const CaseDraft& draft, const anatomy::VirtualPatient& patient, const tasks::Needle& needle,
         const anatomy::TissueTable& tissues)
      : draft_(draft),
        patient_(patient),
        needle_(needle),
        tissues_(tissues),
        statistics_(anatomy::label_statistics(patient)) {}

  std::vector<CaseCheck> run() {
    check_labels();
    check_task();
    check_target();
    check_risks();
    check_zone();
    check_path();
    check_ultrasound();
    check_texts();
    std::stable_sort(lines_.begin(), lines_.end(), [](const CaseCheck& a, const CaseCheck& b) {
      return std::pair(a.step, -static_cast<int>(a.level)) < std::pair(b.step, -static_cast<int>(b.level));
    });
    return std::move(lines_);
  }

 private:
  void add(CheckLevel level, CaseStep step, std::string text, std::optional<Vec3> where_P = {}) {
    lines_.push_back({level, step, std::move(text), where_P});
  }
  void warn(CaseStep step, std::string text, std::optional<Vec3> where_P = {}) {
    add(CheckLevel::kWarning, step, std::move(text), where_P);
  }
  void refuse(CaseStep step, std::string text, std::optional<Vec3> where_P = {}) {
    add(CheckLevel::kError, step, std::move(text), where_P);
  }
  bool is_silent(CaseStep step) const {
    return std::none_of(lines_.begin(), lines_.end(), [&](const CaseCheck& line) { return line.step == step; });
  }

  void check_labels() {
    const std::vector<anatomy::Finding> of_patient = patient_builder::patient_findings(patient_, statistics_);
    for (const anatomy::Finding& finding : draft_.imported->label_findings)
      warn(CaseStep::kLabels, finding.text, finding.place_P);
    for (const anatomy::Finding& finding : of_patient) warn(CaseStep::kLabels, finding.text, finding.place_P);
    const auto& findings = draft_.imported->findings;
    for (const patient_builder::AnatomyFinding& finding : findings)
      if (!patient_builder::is_confirmed(draft_.provenance, finding.name)) warn(CaseStep::kImport, finding.text);
    for (const std::string& warning : draft_.imported->warnings) {
      const auto is_same = [&](const anatomy::Finding& finding) { return finding.text == warning; };
      const auto is_finding = [&](const patient_builder::AnatomyFinding& finding) {
        return warning.starts_with(finding.text);
      };
      const bool is_told =
          std::any_of(of_patient.begin(), of_patient.end(), is_same) ||
          std::any_of(findings.begin(), findings.end(), is_finding) ||
          warning.starts_with("cut off by the border of the CT");  // the same finding in different words
      if (!is_told) warn(CaseStep::kImport, warning);
    }
    look_outside();
    for (const anatomy::LabelStatistics& s : statistics_) {
      const anatomy::Label& label = *patient_.label_table.find(s.id);
      if (!tissues_.find_tissue(label.tissue))
        refuse(CaseStep::kLabels, fmt::format("{}: tissue \"{}\" is not in the tissue table", label.name, label.tissue),
               s.voxels > 0 ? std::optional(s.centroid_P) : std::nullopt);
      check_volume(label, s);
    }
    if (is_silent(CaseStep::kLabels))
      add(CheckLevel::kOk, CaseStep::kLabels,
          fmt::format("{} labels, all inside the body and plausible", statistics_.size()));
    if (is_silent(CaseStep::kImport))
      add(CheckLevel::kOk, CaseStep::kImport, fmt::format("{} is imported", draft_.imported->source));
  }

  void look_outside() {
    std::array<std::size_t, 256> all{}, outside{};
    std::array<std::size_t, 256> first{};
    for (std::size_t n = 0; n < patient_.labels.voxels.size(); ++n) {
      const std::uint8_t id = patient_.labels.voxels[n];
      ++all[id];
      if (id == 0 || static_cast<double>(patient_.skin_distance_mm.voxels[n]) <= kOutside_mm) continue;
      if (outside[id]++ == 0) first[id] = n;
    }
    for (const anatomy::Label& label : patient_.label_table.labels) {
      const double share =
          static_cast<double>(outside[label.id]) / static_cast<double>(std::max<std::size_t>(all[label.id], 1));
      if (share <= kShareOutside) continue;
      const volume::Index3 ijk = patient_.labels.geometry.index_of(first[label.id]);
      refuse(CaseStep::kLabels,
             fmt::format("{:.0f} % of {} is outside the body: does the segmentation belong to this CT?", 100.0 * share,
                         label.name),
             patient_.labels.geometry.centre_mm(ijk));
    }
  }

  void check_volume(const anatomy::Label& label, const anatomy::LabelStatistics& s) {
    if (s.voxels == 0) return;
    for (const OrganVolume& organ : kOrganVolumes) {
      if (label.tissue != organ.tissue) continue;
      if (s.volume_ml > organ.most_ml)
        warn(CaseStep::kLabels,
             fmt::format("{} has {:.0f} ml; more than {:.0f} ml is not plausible", label.name, s.volume_ml,
                         organ.most_ml),
             s.centroid_P);
      if (s.volume_ml < organ.least_ml && !s.touches_border)
        warn(CaseStep::kLabels,
             fmt::format("{} has {:.2f} ml; less than {} ml is not plausible", label.name, s.volume_ml, organ.least_ml),
             s.centroid_P);
    }
  }

  void check_task() {
    const tasks::TaskReadiness readiness = tasks::check_task(draft_.task, patient_);
    for (const std::string& reason : readiness.reasons)
      add(readiness.is_possible ? CheckLevel::kWarning : CheckLevel::kError, CaseStep::kTarget, reason);
  }

  void check_target() {
    const tasks::Task& task = draft_.task;
    if (!task.target_label.empty()) {
      const anatomy::Label* label = patient_.label_table.find(std::string_view(task.target_label));
      const bool is_there = label != nullptr && std::any_of(statistics_.begin(), statistics_.end(), [&](const auto& s) {
                              return s.id == label->id && s.voxels > 0;
                            });
      if (!is_there)
        refuse(CaseStep::kTarget, fmt::format("the target \"{}\" has no voxels", task.target_label));
      else if (find_risk(task, *label) != nullptr)
        refuse(CaseStep::kTarget, fmt::format("the target {} is also a risk structure", label->name));
    }
    const std::optional<Vec3> target_P = find_target_point(draft_);
    if (!target_P) return;
    const double skin_mm = volume::sample_linear(patient_.skin_distance_mm, *target_P);
    if (skin_mm > 0.0) {
      refuse(CaseStep::kTarget, fmt::format("the target is {:.0f} mm outside the body", skin_mm), target_P);
      return;
    }
    const anatomy::Label* label = anatomy::find_label(patient_, *target_P);
    const bool is_wanted = label != nullptr && (tasks::is_target(task, *label) || tasks::is_organ(task, *label));
    const std::string place =
        label != nullptr ? fmt::format("{} ({})", label->name, label->tissue) : "nothing labelled";
    if (!is_wanted && label != nullptr && find_risk(task, *label) != nullptr)
      refuse(CaseStep::kTarget, fmt::format("the target is in {}, a risk structure", place), target_P);
    else if (!is_wanted && task.target_P)
      refuse(CaseStep::kTarget, fmt::format("the target is in {}, not in the {}", place, task.organ), target_P);
    else
      add(CheckLevel::kOk, CaseStep::kTarget,
          fmt::format("the target is in {}, {:.0f} mm below the skin", place, -skin_mm), target_P);
  }

  void check_risks() {
    if (draft_.task.risks.empty()) warn(CaseStep::kTarget, "no risk structures: contact never costs points");
    for (const tasks::RiskStructure& risk : draft_.task.risks) {
      if (risk.label.empty()) continue;
      if (patient_.label_table.find(std::string_view(risk.label)) == nullptr)
        warn(CaseStep::kTarget, fmt::format("the risk structure \"{}\" is not labelled", risk.label));
    }
  }

  void check_zone() {
    if (!draft_.task.entry_zone) return;
    const tasks::EntryZone& zone = *draft_.task.entry_zone;
    const double skin_mm = volume::sample_linear(patient_.skin_distance_mm, zone.centre_P);
    if (std::abs(skin_mm) > kOutside_mm)
      refuse(CaseStep::kPath, fmt::format("the centre of the entry zone is {:.0f} mm from the skin", std::abs(skin_mm)),
             zone.centre_P);
  }

  void check_path() {
    const anatomy::NeedlePath* path = find_expert_path(draft_);
    if (path == nullptr) {
      warn(CaseStep::kPath, "no expert path: it is planned each time the case is opened");
      return;
    }
    const tasks::PathAssessment assessment = tasks::assess_path(draft_.task, patient_, needle_, path->line_P);
    for (const tasks::PathFinding& finding : assessment.findings)
      refuse(CaseStep::kPath, finding.text, finding.where_P);
    if (!assessment.findings.empty()) return;
    add(CheckLevel::kOk, CaseStep::kPath,
        fmt::format("the path is {:.0f} mm long, {:.0f} mm of it in the {}, {:.0f}° off the skin's normal; {}",
                    assessment.path.length_mm, assessment.path.organ_path_mm, draft_.task.organ,
                    assessment.entry_angle_deg,
                    assessment.path.nearest_risk.empty()
                        ? std::string("no risk structure nearby")
                        : fmt::format("{} is {:.1f} mm beyond its margin", assessment.path.nearest_risk,
                                      assessment.path.spare_margin_mm)),
        path->line_P.a);
  }

  void check_ultrasound() {
    if (!draft_.ultrasound)
      return add(CheckLevel::kOk, CaseStep::kUltrasound, "no recorded ultrasound: trainees get the simulated one");
    if (draft_.ultrasound_landmarks.size() >= 3) {
      const auto fit = fit_of_landmarks(draft_);
      if (!fit) warn(CaseStep::kUltrasound, fit.error().text());
      if (fit && !fit->warning.empty()) warn(CaseStep::kUltrasound, fit->warning, place_of(fit->worst));
    }
    if (!draft_.placement)
      return warn(CaseStep::kUltrasound, "the recorded ultrasound has no pose in the CT: it cannot be shown");
    const Vec3 middle_P = draft_.placement->X_PU * middle_of(*draft_.ultrasound);
    if (!detail::check_in_volume(patient_.ct.geometry, middle_P, "middle", ""))
      return refuse(CaseStep::kUltrasound, "the middle of the recorded ultrasound is outside the CT");
    if (draft_.placement->origin == PlacementOrigin::kLandmarks)
      return warn(CaseStep::kUltrasound, "the ultrasound is placed by landmarks only: optimise it, or compare by eye",
                  middle_P);
    const std::string how = draft_.placement->origin == PlacementOrigin::kOptimised
                                ? fmt::format(", confidence {:.2f}", draft_.placement->confidence)
                                : std::string(", by the case that was opened");
    add(CheckLevel::kOk, CaseStep::kUltrasound,
        fmt::format("the ultrasound is registered{}; trainees get {}", how,
                    uses_recorded_ultrasound(draft_) ? "it" : "the simulated one"),
        middle_P);
  }

  /// Place of a landmark in the CT.
  std::optional<Vec3> place_of(const std::string& name) const {
    for (const anatomy::Landmark& landmark : draft_.landmarks)
      if (landmark.name == name) return landmark.p_P;
    return std::nullopt;
  }

  void check_texts() {
    if (draft_.name.empty()) refuse(CaseStep::kSave, "the case has no name");
    if (draft_.description.empty()) warn(CaseStep::kSave, "no description: trainees see only the name");
    if (draft_.provenance.empty()) warn(CaseStep::kSave, "the source of the patient is not stated");
  }

  const CaseDraft& draft_;
  const anatomy::VirtualPatient& patient_;
  const tasks::Needle& needle_;
  const anatomy::TissueTable& tissues_;
  std::vector<anatomy::LabelStatistics> statistics_;
  std::vector<CaseCheck> lines_;
};

}  // namespace

std::vector<CaseCheck> check_draft(const CaseDraft& draft, const anatomy::VirtualPatient& patient,
                                   const tasks::Needle& needle, const anatomy::TissueTable& tissues) {
  return Checks(draft, patient, needle, tissues).run();
}

CheckLevel worst_level(const std::vector<CaseCheck>& checks, CaseStep step) noexcept {
  CheckLevel worst = CheckLevel::kOk;
  for (const CaseCheck& check : checks)
    if (check.step == step) worst = std::max(worst, check.level);
  return worst;
}

}  // namespace trocar::case_builder
