#pragma once

#include <QWidget>
#include <string>

#include "case_builder/case_editor.h"
#include "slices/paint_slice.h"

class QComboBox;
class QLabel;
class QVBoxLayout;

namespace trocar::trainer {

/// Click tool of the case builder in an image.
enum class CaseClick { kLook, kTarget, kZone, kEntry, kTip, kLandmark, kPair };

/// Panel of one step of the case builder: shows the editor's draft and requests changes of it. Stores no part of the
/// draft.
class CasePanel : public QWidget {
  Q_OBJECT

 public:
  CasePanel(case_builder::CaseEditor& editor, QWidget* parent);
  /// Called when the editor has changed; fields with keyboard input keep their text.
  virtual void refresh() = 0;
  /// Marks the button of the active click tool.
  virtual void show_click(CaseClick click);
  /// Name of the item that a click places; empty for an item without a name.
  virtual std::string click_name() const;

 Q_SIGNALS:
  /// A tool was selected, or deselected (kLook).
  void click_requested(trocar::trainer::CaseClick click);
  /// click_name() has changed.
  void click_name_changed();
  void place_requested(const trocar::Vec3& p_P);
  void ultrasound_place_requested(const trocar::Vec3& p_U);
  void fusion_changed(const trocar::slices::FusionStyle& style);
  void label_visible_changed(const QString& name, bool is_visible);
  void label_opacity_changed(double opacity);
  void case_opened(const QString& folder);

 protected:
  QVBoxLayout* content() const noexcept { return content_; }
  /// Adds an empty, wrapped text below the content so far.
  QLabel* add_text(const char* object_name);
  /// A box as wide as the panel, however long its entries are.
  static QComboBox* make_wide_box(const char* object_name, const QString& title, const QString& tooltip);
  /// True while refresh() sets widgets: their signals are not user input then.
  bool is_refreshing_ = false;
  case_builder::CaseEditor& editor_;

 private:
  QVBoxLayout* content_;
};

/// Endings of image files for a file dialog: "*.nii *.nii.gz …".
QString volume_patterns();

CasePanel* make_import_panel(case_builder::CaseEditor& editor, QWidget* parent);
CasePanel* make_labels_panel(case_builder::CaseEditor& editor, QWidget* parent);
CasePanel* make_target_panel(case_builder::CaseEditor& editor, QWidget* parent);
CasePanel* make_path_panel(case_builder::CaseEditor& editor, QWidget* parent);
CasePanel* make_force_panel(case_builder::CaseEditor& editor, QWidget* parent);
CasePanel* make_ultrasound_panel(case_builder::CaseEditor& editor, QWidget* parent);
CasePanel* make_save_panel(case_builder::CaseEditor& editor, QWidget* parent);

}  // namespace trocar::trainer
