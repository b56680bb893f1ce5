#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "case_builder/case_draft.h"
#include "case_builder/case_files.h"
#include "case_builder/checks.h"
#include "case_builder/ultrasound.h"
#include "core/background_job.h"

namespace trocar::case_builder {

/// State of the case builder: the draft with its history, and its background work. Every change triggers new checks and
/// forces. Owned by one thread, which calls advance() once per frame; no call blocks. message() returns errors, one
/// line each.
class CaseEditor {
 public:
  enum class Work : std::uint8_t { kNone, kImporting, kPlanning, kReadingUltrasound, kRegistering, kSaving };

  /// Reads the tables of the data folder; message() returns their errors.
  CaseEditor();
  ~CaseEditor();
  CaseEditor(const CaseEditor&) = delete;
  CaseEditor& operator=(const CaseEditor&) = delete;

  /// Collects finished work and starts requested work. Returns true if displayed data may have changed.
  bool advance();

  const CaseDraft& draft() const noexcept { return history_.draft(); }
  const CaseHistory& history() const noexcept { return history_; }
  bool has_patient() const noexcept { return draft().imported != nullptr; }
  /// The patient with the label names and tissues of the last check; null without an import.
  std::shared_ptr<const anatomy::VirtualPatient> patient() const noexcept { return patient_; }
  std::shared_ptr<const std::vector<anatomy::NamedMesh>> meshes() const noexcept { return meshes_; }

  /// An edit of the draft (case_edits.h); its error becomes the message. False if it was rejected.
  bool edit(Result<CaseDraft> next, std::string what, const std::string& gesture = {});
  void undo();
  void redo();

  /// Starts a new import, which replaces the draft on success. Cancels a running import.
  void import_patient(ImportRequest request);
  /// Starts the planner for the expert's path, from target, entry zone and risks.
  void plan_path();
  /// Reads an ultrasound volume; it replaces that of the draft.
  void read_ultrasound(UltrasoundRequest request);
  /// Starts the registration of the ultrasound with the CT.
  void register_ultrasound(RegistrationStart start);
  void save(SaveOptions options);
  /// Cancels the running work. Saving is not cancelled: a case is written completely.
  void cancel();
  Work work() const noexcept { return work_; }
  JobView work_view() const;

  /// Checks of the newest checked draft; is_reviewed() is true if that is the current draft.
  const std::vector<CaseCheck>& checks() const noexcept { return checks_; }
  const std::optional<ForcePreview>& preview() const noexcept { return preview_; }
  const std::string& preview_error() const noexcept { return preview_error_; }
  bool is_reviewed() const noexcept { return reviewed_version_ == history_.version(); }

  const std::string& message() const noexcept { return message_; }
  bool is_error() const noexcept { return is_error_; }
  void say(std::string message, bool is_error = false);
  /// Folder of the last saved case; empty: none.
  const std::filesystem::path& saved_folder() const noexcept { return saved_; }
  /// True if the last saved state is the current draft.
  bool is_saved() const noexcept { return has_patient() && saved_version_ == history_.version(); }

  const std::vector<tasks::Task>& templates() const noexcept { return templates_; }
  const std::vector<tasks::Needle>& needles() const noexcept { return needles_; }
  const anatomy::TissueTable& tissues() const noexcept { return tissues_; }
  /// Needle of the draft's task; nullptr if the list lacks it.
  const tasks::Needle* needle() const noexcept;

 private:
  struct Review {
    std::uint64_t version = 0;
    std::vector<CaseCheck> checks;
    std::shared_ptr<const anatomy::VirtualPatient> patient;
    std::optional<ForcePreview> preview;
    std::string preview_error;
  };

  Status load_tables();
  bool take_import();
  bool take_plan();
  bool take_ultrasound();
  bool take_placement();
  bool take_save();
  bool take_review();
  void start_review();

  CaseHistory history_;
  std::shared_ptr<DraftPatient> patients_ = std::make_shared<DraftPatient>();
  std::shared_ptr<const anatomy::VirtualPatient> patient_;
  std::shared_ptr<const std::vector<anatomy::NamedMesh>> meshes_;
  std::shared_ptr<const ImportedPatient> meshes_of_;
  anatomy::LabelTable meshes_table_;

  std::vector<tasks::Task> templates_;
  std::vector<tasks::Needle> needles_;
  anatomy::TissueTable tissues_;

  Work work_ = Work::kNone;
  BackgroundJob<CaseDraft> import_;
  BackgroundJob<Segment> plan_;
  BackgroundJob<std::shared_ptr<const ImportedUltrasound>> ultrasound_;
  BackgroundJob<UltrasoundPlacement> placement_;
  BackgroundJob<std::filesystem::path> save_;
  BackgroundJob<Review> review_;
  bool is_reviewing_ = false;
  RetiredJobs retired_;
  std::uint64_t plan_version_ = 0;
  std::shared_ptr<const ImportedUltrasound> registered_;  ///< Ultrasound of the running registration.
  std::uint64_t save_version_ = 0;

  std::vector<CaseCheck> checks_;
  std::optional<ForcePreview> preview_;
  std::string preview_error_;
  std::uint64_t reviewed_version_ = ~std::uint64_t{0};
  std::uint64_t saved_version_ = ~std::uint64_t{0};
  std::filesystem::path saved_;
  std::string message_;
  bool is_error_ = false;
  std::uint64_t told_version_ = ~std::uint64_t{0};
  double told_fraction_ = -1.0;
  bool has_news_ = true;
};

}  // namespace trocar::case_builder
