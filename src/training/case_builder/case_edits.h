#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "case_builder/case_draft.h"
#include "core/result.h"

namespace trocar::case_builder {

inline constexpr const char* kExpertPath = "expert";  ///< Name of the path that the case builder draws.

// Each function returns a copy of the draft with one change, or an error; the input is not modified.

/// Names are unique and not empty. Risks and a target that name the label are changed, too.
Result<CaseDraft> rename_label(CaseDraft draft, std::uint8_t id, const std::string& name);
/// `tissue`: a name of the tissue table; the caller ensures this.
Result<CaseDraft> set_label_tissue(CaseDraft draft, std::uint8_t id, const std::string& tissue);
Result<CaseDraft> set_label_color(CaseDraft draft, std::uint8_t id, const image::Rgb& color);

/// Uses the task of another template; target, zone and path stay.
CaseDraft use_template(CaseDraft draft, const tasks::Task& base);
/// Sets the point that the needle must reach: inside the volume.
Result<CaseDraft> set_target_point(CaseDraft draft, const Vec3& p_P);
/// Sets the target label (empty: all labels of the template's target tissues) and clears a target point.
Result<CaseDraft> set_target_label(CaseDraft draft, const std::string& name);

/// Adds a risk structure, or changes the one of the same tissue or label. Margin 0..50 mm.
Result<CaseDraft> set_risk(CaseDraft draft, const tasks::RiskStructure& risk);
Result<CaseDraft> remove_risk(CaseDraft draft, std::size_t row);

/// Sets a disc on the skin; the centre is projected onto it. Radius 1..200 mm. Error: no skin near the point.
Result<CaseDraft> set_entry_zone(CaseDraft draft, const Vec3& near_P, double radius_mm);
CaseDraft clear_entry_zone(CaseDraft draft);

/// Sets the expert's path, from the skin to the end position of the tip; at least 5 mm long.
Result<CaseDraft> set_expert_path(CaseDraft draft, const Segment& line_P);
CaseDraft clear_expert_path(CaseDraft draft);

/// Keeps in the provenance that a finding of the import is right.
CaseDraft confirm_finding(CaseDraft draft, const patient_builder::AnatomyFinding& finding);

/// Adds a landmark inside the volume, or moves the one of that name.
Result<CaseDraft> set_landmark(CaseDraft draft, const std::string& name, const Vec3& p_P);
/// Names are unique and not empty. The landmark of that name in the ultrasound is renamed, too.
Result<CaseDraft> rename_landmark(CaseDraft draft, std::size_t row, const std::string& name);
Result<CaseDraft> remove_landmark(CaseDraft draft, std::size_t row);

/// Common clinical names of landmarks that are visible or palpable on the skin: trunk from head to feet, then the back.
std::span<const std::string_view> landmark_names() noexcept;

}  // namespace trocar::case_builder
