#include "case_builder/case_editor.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "case_builder/case_edits.h"
#include "core/files/folders.h"
#include "tasks/plan.h"

namespace trocar::case_builder {
namespace fs = std::filesystem;

CaseEditor::CaseEditor() {
  if (const Status loaded = load_tables(); !loaded) say(loaded.error().text(), true);
}
CaseEditor::~CaseEditor() = default;

Status CaseEditor::load_tables() {
  TROCAR_TRY(const std::filesystem::path data, checked_data_dir());
  TROCAR_TRY(templates_, tasks::load_tasks(data / "tasks"));
  TROCAR_TRY(needles_, tasks::load_needles(data / "needles.toml"));
  TROCAR_TRY(tissues_, anatomy::load_tissue_table(data / "tissues.toml"));
  return {};
}

const tasks::Needle* CaseEditor::needle() const noexcept {
  const auto found = std::find_if(needles_.begin(), needles_.end(),
                                  [&](const tasks::Needle& needle) { return needle.name == draft().task.needle; });
  return found != needles_.end() ? &*found : nullptr;
}

void CaseEditor::say(std::string message, bool is_error) {
  message_ = std::move(message);
  is_error_ = is_error;
  has_news_ = true;
}

bool CaseEditor::edit(Result<CaseDraft> next, std::string what, const std::string& gesture) {
  if (!next) {
    say(next.error().text(), true);
    return false;
  }
  history_.apply(std::move(*next), std::move(what), gesture);
  if (is_error_) say({});
  return true;
}

void CaseEditor::undo() {
  if (!history_.can_undo()) return;
  say("Undone: " + history_.undo_text());
  history_.undo();
}

void CaseEditor::redo() {
  if (!history_.can_redo()) return;
  say("Redone: " + history_.redo_text());
  history_.redo();
}

void CaseEditor::import_patient(ImportRequest request) {
  if (work_ == Work::kSaving) return say("the case is being saved; wait a moment", true);
  cancel();
  import_ = BackgroundJob<CaseDraft>([request = std::move(request)](const Progress& progress, std::stop_token stop) {
    return import_case(request, progress, stop);
  });
  work_ = Work::kImporting;
  say({});
}

void CaseEditor::plan_path() {
  if (work_ != Work::kNone || !has_patient()) return;
  const tasks::Needle* the_needle = needle();
  if (the_needle == nullptr) return say("there is no needle \"" + draft().task.needle + "\"", true);
  plan_version_ = history_.version();
  plan_ = BackgroundJob<Segment>(
      [draft = draft(), patients = patients_, needle = *the_needle](const Progress& progress) -> Result<Segment> {
        const auto patient = patients->of(draft);
        TROCAR_TRY(const auto paths, tasks::plan_paths(draft.task, *patient, needle, {}, progress));
        return paths.front().line_P;
      });
  work_ = Work::kPlanning;
  say({});
}

void CaseEditor::read_ultrasound(UltrasoundRequest request) {
  if (work_ != Work::kNone) return say("another job is running; wait a moment", true);
  if (!has_patient()) return say("there is no patient yet: import a CT with its labels first", true);
  ultrasound_ = BackgroundJob<std::shared_ptr<const ImportedUltrasound>>(
      [request = std::move(request)](const Progress& progress) {
        report(progress, "reading the ultrasound", 0.0);
        return case_builder::read_ultrasound(request, progress);
      });
  work_ = Work::kReadingUltrasound;
  say({});
}

void CaseEditor::register_ultrasound(RegistrationStart start) {
  if (work_ != Work::kNone) return say("another job is running; wait a moment", true);
  if (!has_patient() || !draft().ultrasound) return say("there is no ultrasound yet: read a volume first", true);
  registered_ = draft().ultrasound;
  placement_ = BackgroundJob<UltrasoundPlacement>(
      [draft = draft(), start](const Progress& progress, const std::stop_token& stop) {
        report(progress, "registering the ultrasound", 0.0);
        return find_placement(draft, start, progress, stop);
      });
  work_ = Work::kRegistering;
  say({});
}

void CaseEditor::save(SaveOptions options) {
  if (work_ != Work::kNone) return say("another job is running; wait a moment", true);
  save_version_ = history_.version();
  save_ = BackgroundJob<fs::path>([draft = draft(), patients = patients_,
                                   options = std::move(options)](const Progress& progress) -> Result<fs::path> {
    const CompleteWork complete;
    TROCAR_TRY_STATUS(save_case(draft, *patients, options, progress));
    return fs::absolute(options.folder);
  });
  work_ = Work::kSaving;
  say({});
}

void CaseEditor::cancel() {
  if (work_ == Work::kNone || work_ == Work::kSaving) return;
  retired_.retire(std::exchange(import_, {}));
  retired_.retire(std::exchange(plan_, {}));
  retired_.retire(std::exchange(ultrasound_, {}));
  retired_.retire(std::exchange(placement_, {}));
  work_ = Work::kNone;
  say("Cancelled; nothing was changed.");
}

JobView CaseEditor::work_view() const {
  switch (work_) {
    case Work::kImporting:
      return import_.view();
    case Work::kPlanning:
      return plan_.view();
    case Work::kReadingUltrasound:
      return ultrasound_.view();
    case Work::kRegistering:
      return placement_.view();
    case Work::kSaving:
      return save_.view();
    case Work::kNone:
      break;
  }
  return {};
}

bool CaseEditor::take_import() {
  auto draft = import_.take();
  if (!draft) return false;
  work_ = Work::kNone;
  import_ = {};
  if (!*draft) {
    say(draft->error().text(), true);
    return true;
  }
  history_.begin(std::move(**draft));
  patient_ = patients_->find(this->draft());
  checks_.clear();
  preview_.reset();
  say(fmt::format("{} is imported: {} labels.", this->draft().name, this->draft().label_table.labels.size()));
  return true;
}

bool CaseEditor::take_plan() {
  const auto line_P = plan_.take();
  if (!line_P) return false;
  work_ = Work::kNone;
  plan_ = {};
  if (!*line_P) {
    say(line_P->error().text(), true);
  } else if (plan_version_ != history_.version()) {
    say("The case changed during planning: plan again.", true);
  } else if (edit(set_expert_path(draft(), **line_P), "planned path")) {
    say(fmt::format("Planned: a path of {:.0f} mm.", (*line_P)->length_mm()));
  }
  return true;
}

bool CaseEditor::take_ultrasound() {
  auto read = ultrasound_.take();
  if (!read) return false;
  work_ = Work::kNone;
  ultrasound_ = {};
  if (!*read) {
    say(read->error().text(), true);
    return true;
  }
  const volume::GridGeometry& grid = (**read)->gray_U.geometry;
  const Vec3 size_mm = grid.spacing_mm.cwiseProduct(volume::to_vec3(grid.size));
  const std::string source = (**read)->source;
  edit(set_ultrasound(draft(), *std::move(*read)), "read an ultrasound");
  say(fmt::format("{} is read: {:.0f} x {:.0f} x {:.0f} mm.", fs::path(source).filename().string(), size_mm.x(),
                  size_mm.y(), size_mm.z()));
  return true;
}

bool CaseEditor::take_placement() {
  const auto placement = placement_.take();
  if (!placement) return false;
  work_ = Work::kNone;
  placement_ = {};
  if (!*placement) {
    say(placement->error().text(), true);
  } else if (registered_ != draft().ultrasound) {
    say("The ultrasound changed during the registration: register it again.", true);
  } else {
    CaseDraft next = draft();
    next.placement = **placement;
    edit(std::move(next), "register the ultrasound");
    say(fmt::format("Registered with a confidence of {:.2f}: compare ultrasound and CT in the slices.",
                    (*placement)->confidence));
  }
  registered_.reset();
  return true;
}

bool CaseEditor::take_save() {
  const auto folder = save_.take();
  if (!folder) return false;
  work_ = Work::kNone;
  save_ = {};
  if (!*folder) {
    say(folder->error().text(), true);
    return true;
  }
  saved_ = **folder;
  saved_version_ = save_version_;
  say("Saved: " + (*folder)->string());
  return true;
}

void CaseEditor::start_review() {
  const tasks::Needle* the_needle = needle();
  is_reviewing_ = true;
  review_ = BackgroundJob<Review>(
      [draft = draft(), version = history_.version(), patients = patients_, tissues = tissues_,
       needle = the_needle != nullptr ? *the_needle : tasks::Needle{}](const Progress&) -> Result<Review> {
        Review review;
        review.version = version;
        review.patient = patients->of(draft);
        review.checks = check_draft(draft, *review.patient, needle, tissues);
        if (auto preview = preview_forces(draft, review.patient, needle, tissues)) {
          review.preview = std::move(*preview);
        } else {
          review.preview_error = preview.error().text();
        }
        return review;
      });
}

bool CaseEditor::take_review() {
  if (!is_reviewing_) return false;
  auto review = review_.take();
  if (!review) return false;
  is_reviewing_ = false;
  review_ = {};
  if (!*review) {
    say(review->error().text(), true);
    reviewed_version_ = history_.version();
    return true;
  }
  if (!draft().imported) return true;
  reviewed_version_ = (*review)->version;
  checks_ = std::move((*review)->checks);
  preview_ = std::move((*review)->preview);
  preview_error_ = std::move((*review)->preview_error);
  if (auto patient = patients_->find(draft())) patient_ = std::move(patient);
  return true;
}

bool CaseEditor::advance() {
  retired_.sweep();
  bool is_new = std::exchange(has_news_, false);
  is_new |= take_import();
  is_new |= take_plan();
  is_new |= take_ultrasound();
  is_new |= take_placement();
  is_new |= take_save();
  is_new |= take_review();
  if (has_patient() && !is_reviewing_ && !is_reviewed()) start_review();
  if (has_patient()) {
    const bool is_other_import = meshes_of_ != draft().imported;
    const bool has_other_names =
        !std::equal(meshes_table_.labels.begin(), meshes_table_.labels.end(), draft().label_table.labels.begin(),
                    draft().label_table.labels.end(),
                    [](const anatomy::Label& a, const anatomy::Label& b) { return a.name == b.name; });
    if (is_other_import || has_other_names) {
      meshes_ = draft_meshes(draft());
      meshes_of_ = draft().imported;
      meshes_table_ = draft().label_table;
    }
    if (auto patient = patients_->find(draft()); patient && patient != patient_) {
      patient_ = std::move(patient);
      is_new = true;
    }
  }
  const double fraction = work_view().fraction;
  is_new |= told_version_ != history_.version() || told_fraction_ != fraction || has_news_;
  told_version_ = history_.version();
  told_fraction_ = fraction;
  has_news_ = false;
  return is_new;
}

}  // namespace trocar::case_builder
