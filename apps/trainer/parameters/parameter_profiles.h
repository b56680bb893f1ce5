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

/// The profiles of a folder: one is chosen, the numbers are saved under a name, one is deleted. Names and questions are
/// asked below the choice, never in a window of their own.
///
/// Keys: Up and Down choose, Enter in the name saves, Escape closes the question. Object names: parameter-profile
/// (choice; its first entry is the case's own numbers), parameter-profile-save-as, parameter-profile-delete,
/// parameter-profile-name, parameter-profile-question, parameter-profile-yes, parameter-profile-no,
/// parameter-profile-problem.
class ParameterProfiles : public QWidget {
  Q_OBJECT

 public:
  explicit ParameterProfiles(QWidget* parent = nullptr);

  void set_folder(const std::filesystem::path& folder);
  const std::filesystem::path& folder() const noexcept { return folder_; }
  /// Looks at the folder again; it may be another program's, too.
  void read_folder();
  /// Nullptr: there is none of that file.
  const cases::TissueProfile* find(const std::string& file) const noexcept;
  /// The profile of that file stands in the choice; empty: the case's own. A dot says that numbers or model differ.
  void show_chosen(const std::string& file, bool differs);
  /// What went wrong; empty hides it.
  void show_problem(const QString& text);
  /// What was asked to be saved has been saved.
  void finish_saving(const cases::TissueProfile& saved);

 Q_SIGNALS:
  /// By its file; empty: the case's own.
  void chosen(const std::string& file);
  /// With name and note; the numbers are the listener's.
  void save_asked(const cases::TissueProfile& profile, bool may_replace);
  /// Profiles have come or gone.
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
  void tell(const QString& text, bool is_problem);
  /// The profile that saving under this name would replace: one of that name, or one in that name's file.
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
