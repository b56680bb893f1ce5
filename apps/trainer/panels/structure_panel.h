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

/// Structures and display options of a 3D view: one row per structure (colour, name, opacity, eye), presets, volume
/// rendering of the CT, planes along the needle, guidance, landmarks, camera and stereo. Changes of opacity can be
/// undone; the drag of a slider is one step. Object names: structure-eye-NAME, structure-opacity-NAME (with '-' for
/// '_'), preset-all, preset-skin, preset-bones, preset-vessels, preset-target, volume-preset, plane-long, plane-cross,
/// plane-tip, show-guidance, show-landmarks, camera-menu, stereo-menu, structure-undo, structure-redo.
///
/// Keys: Tab moves through all controls; arrows move a slider, Space toggles an eye; Ctrl+Z and Ctrl+Shift+Z undo and
/// redo while the focus is in the panel.
class StructurePanel : public QWidget {
  Q_OBJECT

 public:
  /// The view must outlive the panel.
  explicit StructurePanel(PatientView& view, QWidget* parent = nullptr);

  /// Call after show_patient: creates the rows for the structures of the view.
  void rebuild();
  /// True if the view has other structures than the list: call rebuild().
  bool is_outdated() const;
  /// Displays the present settings of the view (a key may have changed them). Cheap.
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
  /// Adds an undo step; the drag of `slider` is one step.
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
  const QSlider* dragged_ = nullptr;  ///< Slider of the last step, while it is held.
  std::optional<UndoButtons> undo_buttons_;
};

}  // namespace trocar::trainer
