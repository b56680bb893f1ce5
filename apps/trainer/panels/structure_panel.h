#pragma once

#include <QWidget>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/step_history.h"
#include "scene/structure.h"
#include "ui_kit/undo_buttons.h"

class QBoxLayout;
class QComboBox;
class QMenu;
class QSlider;
class QToolButton;
class QVBoxLayout;

namespace trocar::trainer {

class PatientView;

/// What a 3D view shows: a row a structure (colour, name, opacity, eye), presets, the CT cloud, planes along the
/// needle, guidance, landmarks, camera and stereo. Opacities can be undone, a slider's drag as one step. Object names:
/// structure-eye-NAME, structure-opacity-NAME (with '-' for '_'), preset-all, preset-skin, preset-bones,
/// preset-vessels, preset-target, volume-preset, plane-long, plane-cross, plane-tip, show-guidance, show-landmarks,
/// camera-menu, stereo-menu, structure-undo, structure-redo.
///
/// Keys: Tab walks through all controls; arrows move a slider, Space flips an eye; Ctrl+Z and Ctrl+Shift+Z while the
/// focus is in the panel.
class StructurePanel : public QWidget {
  Q_OBJECT

 public:
  /// The view outlives the panel.
  explicit StructurePanel(PatientView& view, QWidget* parent = nullptr);

  /// After show_patient: rows for the structures of the view.
  void rebuild();
  /// Takes over what the view shows (a key may have changed it). Cheap.
  void refresh();

 private:
  struct Row {
    scene::StructureInfo info;
    QWidget* line = nullptr;
    QToolButton* eye = nullptr;
    QSlider* slider = nullptr;
  };

  using Opacities = std::map<std::string, double>;
  Opacities opacities() const;
  /// One step of undo; `slider`: of this row, whose drag is one step.
  void note_change(const QSlider* slider = nullptr);
  void show_step();

  void add_presets(QBoxLayout& layout);
  void add_row(const scene::StructureInfo& info);
  void add_volume(QBoxLayout& layout);
  void add_toggles(QBoxLayout& layout);
  void add_menus(QBoxLayout& layout);
  void fill_camera_menu(QMenu& menu);
  void fill_stereo_menu(QMenu& menu);

  PatientView& view_;
  QVBoxLayout* list_ = nullptr;
  QComboBox* volume_ = nullptr;
  QToolButton* guidance_ = nullptr;
  QToolButton* landmarks_ = nullptr;
  std::vector<Row> rows_;
  StepHistory<Opacities> steps_;
  const QSlider* dragged_ = nullptr;  ///< Has made the last step and is still held.
  std::optional<UndoButtons> undo_buttons_;
};

}  // namespace trocar::trainer
