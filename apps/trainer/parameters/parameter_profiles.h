#pragma once

#include <QString>
#include <QWidget>
#include <filesystem>
#include <string>
#include <vector>

#include "cases/tissue_profile.h"

class QComboBox;
class QLabel;
class QLineEdit;
class QPushButton;
class QToolButton;

namespace trocar::trainer {

/// Selects, saves and deletes the profiles of a folder. Input of names and questions appear below the combo box, never
/// in a separate window.
///
/// Keys: Up and Down select, Enter in the name field saves, Escape closes the question. Object names: parameter-profile
/// (combo box; its first entry is the case's numbers), parameter-profile-save-as, parameter-profile-delete,
/// parameter-profile-name, parameter-profile-question, parameter-profile-yes, parameter-profile-no,
/// parameter-profile-problem.
class ParameterProfiles : public QWidget {
  Q_OBJECT

 public:
  explicit ParameterProfiles(QWidget* parent = nullptr);

  void set_folder(const std::filesystem::path& folder);
  const std::filesystem::path& folder() const noexcept { return folder_; }
  /// Reads the folder again; other programs may also use it.
  void read_folder();
  /// nullptr if no profile has that file.
  const cases::TissueProfile* find(const std::string& file) const noexcept;
  /// Shows the profile of that file in the combo box; empty: the case's numbers. A dot marks that numbers or model
  /// differ.
  void show_chosen(const std::string& file, bool differs);
  /// Shows an error; empty hides it.
  void show_problem(const QString& text);
  /// Call after the requested profile was saved.
  void finish_saving(const cases::TissueProfile& saved);

 Q_SIGNALS:
  /// File of the selected profile; empty: the case's numbers.
  void chosen(const std::string& file);
  /// Request to save; `profile` has name and note, and the receiver adds the numbers.
  void save_asked(const cases::TissueProfile& profile, bool may_replace);
  /// Profiles were added or removed.
  void listed();

 protected:
  bool event(QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void showEvent(QShowEvent* event) override;

 private:
  enum class Question { kNone, kName, kReplace, kDelete };

  QWidget* make_choice();
  QWidget* make_question();
  void ask(Question question);
  void answer_yes();
  void answer_no();
  void save();
  void remove();
  void list_entries();
  void show_message(const QString& text, bool is_problem);
  /// The profile that a save under this name would replace: one of that name, or one in the file of that name.
  const cases::TissueProfile* find_same(const std::string& name) const noexcept;
  const cases::TissueProfile* current() const noexcept;

  std::filesystem::path folder_;
  std::vector<cases::TissueProfile> profiles_;
  std::string chosen_;
  bool differs_ = false;
  Question question_ = Question::kNone;
  QComboBox* choice_ = nullptr;
  QToolButton *save_as_ = nullptr, *delete_ = nullptr;
  QWidget* asked_ = nullptr;
  QLineEdit* name_ = nullptr;
  QLabel *words_ = nullptr, *problem_ = nullptr;
  QPushButton *yes_ = nullptr, *no_ = nullptr;
};

}  // namespace trocar::trainer
