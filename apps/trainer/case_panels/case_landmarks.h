#pragma once

#include <QWidget>
#include <string>

#include "case_builder/case_editor.h"
#include "geometry/pose.h"

class QComboBox;
class QListWidget;
class QPushButton;

namespace trocar::trainer {

/// The landmarks of a case: a name from the list or any other, a tool that places the landmark by a click, and a list
/// of all landmarks. Object names: case-landmark-name, case-landmark-pick, case-landmarks, case-landmark-rename,
/// case-landmark-remove. Keys: Ctrl+L selects the tool; in the list F2 renames, Delete removes, Enter shows the
/// landmark's position.
class CaseLandmarks : public QWidget {
  Q_OBJECT

 public:
  explicit CaseLandmarks(case_builder::CaseEditor& editor, QWidget* parent = nullptr);

  void refresh();
  void show_picking(bool is_on);
  /// Name of the landmark that the tool places.
  std::string name() const;

 Q_SIGNALS:
  void picking_requested(bool is_on);
  /// name() has changed.
  void name_changed();
  void place_requested(const trocar::Vec3& p_P);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void add_naming();
  void add_list();
  void add_buttons();
  void rename(int row);
  void remove_current();

  case_builder::CaseEditor& editor_;
  QComboBox* name_ = nullptr;
  QPushButton* pick_ = nullptr;
  QListWidget* list_ = nullptr;
  QPushButton* rename_ = nullptr;
  QPushButton* remove_ = nullptr;
  bool is_refreshing_ = false;
};

}  // namespace trocar::trainer
