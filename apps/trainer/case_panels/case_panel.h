#pragma once

#include <QWidget>
#include <string>

#include "case_builder/case_editor.h"

class QVBoxLayout;

namespace trocar::trainer {

/// What a click into a picture means to the case builder.
enum class CaseClick { kLook, kTarget, kZone, kEntry, kTip, kLandmark };

/// One step of making a case: shows the editor's draft and asks it for changes. Keeps nothing of the draft itself.
class CasePanel : public QWidget {
  Q_OBJECT

 public:
  CasePanel(case_builder::CaseEditor& editor, QWidget* parent);
  /// The editor has something new; fields that a person types in keep their text.
  virtual void refresh() = 0;
  /// The click tool that is on, so that its button shows it.
  virtual void show_click(CaseClick click);
  /// Of what a click places; empty: of nothing that has a name.
  virtual std::string click_name() const;

 Q_SIGNALS:
  /// A tool was chosen, or put away (kLook).
  void click_requested(trocar::trainer::CaseClick click);
  /// click_name() is another one.
  void click_name_changed();
  void place_requested(const trocar::Vec3& p_P);
  void label_visible_changed(const QString& name, bool is_visible);
  void label_opacity_changed(double opacity);
  void case_opened(const QString& folder);

 protected:
  QVBoxLayout* content() const noexcept { return content_; }
  /// True while refresh() sets widgets: their signals are no wishes then.
  bool is_refreshing_ = false;
  case_builder::CaseEditor& editor_;

 private:
  QVBoxLayout* content_;
};

CasePanel* make_import_panel(case_builder::CaseEditor& editor, QWidget* parent);
CasePanel* make_labels_panel(case_builder::CaseEditor& editor, QWidget* parent);
CasePanel* make_target_panel(case_builder::CaseEditor& editor, QWidget* parent);
CasePanel* make_path_panel(case_builder::CaseEditor& editor, QWidget* parent);
CasePanel* make_force_panel(case_builder::CaseEditor& editor, QWidget* parent);
CasePanel* make_save_panel(case_builder::CaseEditor& editor, QWidget* parent);

}  // namespace trocar::trainer
