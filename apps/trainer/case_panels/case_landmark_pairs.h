#pragma once

#include <QWidget>
#include <string>

#include "case_builder/case_editor.h"
#include "geometry/pose.h"

class QComboBox;
class QLabel;
class QPushButton;
class QTableWidget;

namespace trocar::trainer {

/// Landmarks that the CT and the recorded ultrasound share: a name, a tool that places it by one click in each volume,
/// a list with the residual of each pair, and the fit of the pose by them. Object names: case-pair-name,
/// case-pair-new, case-pair-pick, case-pairs, case-pair-remove, case-pair-fit. Keys: Ctrl+U selects the tool; in the
/// list Delete removes the landmark of the ultrasound, Enter shows its position.
class CaseLandmarkPairs : public QWidget {
  Q_OBJECT

 public:
  explicit CaseLandmarkPairs(case_builder::CaseEditor& editor, QWidget* parent = nullptr);

  void refresh();
  void show_picking(bool is_on);
  /// Name of the landmark that the tool places.
  std::string name() const;

 Q_SIGNALS:
  void picking_requested(bool is_on);
  /// name() has changed.
  void name_changed();
  void place_requested(const trocar::Vec3& p_P);
  void ultrasound_place_requested(const trocar::Vec3& p_U);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void begin_next();
  void add_naming();
  void add_list();
  void add_buttons();
  void fill_list();
  void fill_names();
  void show_row(int row);
  void remove_current();

  case_builder::CaseEditor& editor_;
  QComboBox* name_ = nullptr;
  QPushButton* pick_ = nullptr;
  QTableWidget* list_ = nullptr;
  QPushButton* remove_ = nullptr;
  QPushButton* fit_ = nullptr;
  QLabel* result_ = nullptr;
};

}  // namespace trocar::trainer
