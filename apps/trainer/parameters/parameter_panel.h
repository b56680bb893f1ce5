#pragma once

#include <QString>
#include <QStringList>
#include <QWidget>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>

#include "cases/open_case.h"
#include "cases/tissue_profile.h"
#include "parameters/parameter_edits.h"
#include "ui_kit/undo_buttons.h"

class QLabel;
class QScrollArea;
class QToolButton;

namespace trocar::trainer {

class ForcePreview;
class ParameterList;
class ParameterProfiles;

/// Fits the mechanical numbers of the tissues to the patient (paper A: "an interface to facilitate users in adaptively
/// adjusting these parameters"), for both force models, with the predicted force. The defaults are the case's numbers;
/// changes persist when another case with the same tissues is shown.
///
/// Keys while the focus is in the panel: Ctrl+Z undo, Ctrl+Shift+Z redo. Object names: parameter-panel, parameter-undo,
/// parameter-redo, parameter-reset-all; for its parts see ForcePreview, ParameterList, ParameterRow, ParameterProfiles.
class ParameterPanel : public QWidget {
  Q_OBJECT

 public:
  explicit ParameterPanel(QWidget* parent = nullptr);

  /// Null: no case, nothing to adjust.
  void show_case(std::shared_ptr<const cases::OpenCase> open_case);
  /// Folder of the profiles; by default in the user's configuration folder.
  void set_profile_folder(const std::filesystem::path& folder);
  /// Call once per frame: sends changes and polls the background work.
  void advance();

  /// Present differences from the case's numbers: "liver.k=0.5".
  QStringList settings() const;
  std::vector<anatomy::TissueSetting> changes() const { return edits_.changes(); }
  /// Applies all changes as one undo step. Errors: an unknown name, a number out of range.
  Status apply_settings(const QStringList& settings);
  const ForcePreview& preview() const noexcept { return *preview_; }
  /// True if every change was sent and predicted.
  bool is_settled() const noexcept;

  QSize sizeHint() const override;

 Q_SIGNALS:
  /// All differences from the case's numbers, with a short delay after the last change; empty without differences.
  void parameters_changed(QStringList settings);
  void model_changed(QString model);

 private:
  QWidget* make_head();
  void edit(const std::string& setting, double value, bool joins);
  void undo();
  void redo();
  /// Shows the present numbers; sends the differences after a short delay.
  void show_changes();
  void show_values();
  void show_model();
  void choose_profile(const std::string& file);
  void save_profile_as(cases::TissueProfile profile, bool may_replace);
  void scroll_to_opened();

  std::shared_ptr<const cases::OpenCase> case_;
  ParameterEdits edits_;
  QStringList sent_;
  std::optional<std::chrono::steady_clock::time_point> changed_at_;  ///< Time of a change that was not sent yet.
  std::optional<UndoButtons> undo_buttons_;
  QToolButton* reset_ = nullptr;
  QLabel* empty_;
  QWidget* body_;
  ParameterProfiles* profiles_;
  ForcePreview* preview_;
  QScrollArea* scroll_;
  ParameterList* list_;
};

}  // namespace trocar::trainer
