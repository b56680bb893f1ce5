#pragma once

#include <QString>
#include <optional>
#include <vector>

#include "cases/open_case.h"
#include "choice/trainer_choice.h"

namespace trocar::trainer {

/// A row of a form: heading and rich text.
struct BriefingRow {
  QString heading;
  QString text;  ///< HTML.

  bool operator==(const BriefingRow&) const = default;
};

/// The referral, as far as it is known before the patient is loaded: patient, indication, coagulation, allergies,
/// posture. What nobody stated is called so.
std::vector<BriefingRow> referral_rows(const TrainerChoice& choice);
/// What the images of a loaded patient add: the lesion with its segment and size, its depth, and what is doubtful.
std::vector<BriefingRow> finding_rows(const cases::Case& the_case);
/// Goal, guidance, needle and steps, from the tables alone (cases::load_tables). `is_parenchymal`: there is no lesion;
/// empty: not known yet.
std::vector<BriefingRow> procedure_rows(const cases::Case& tables, std::optional<bool> is_parenchymal = {});
/// The planned path of a loaded case.
BriefingRow path_row(const cases::Case& the_case);
/// Points of each part, the mark to pass, and what must not be touched; from the tables alone.
std::vector<BriefingRow> scoring_rows(const cases::Case& tables);
/// How tools are moved by the chosen devices; `has_gun`: and the biopsy gun is fired.
std::vector<BriefingRow> control_rows(const TrainerChoice& choice, const cases::Case* tables);
/// The target is a lesion, or healthy tissue in its place.
bool is_lesion_task(const tasks::Task& task);

/// A form as HTML: headings in the left column.
QString form_html(const std::vector<BriefingRow>& rows);

/// Task, needle and tissues of a choice, without its patient.
Result<cases::Case> load_briefing_tables(const TrainerChoice& choice);

}  // namespace trocar::trainer
