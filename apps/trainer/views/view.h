#pragma once

#include <QObject>
#include <QString>
#include <functional>
#include <memory>
#include <vector>

#include "cases/open_case.h"
#include "choice/training_mode.h"
#include "views/tools_shown.h"

class QWidget;

namespace trocar::ultrasound {
struct ScanPicture;
}  // namespace trocar::ultrasound

namespace trocar::trainer {

class PatientView;

/// The opened case, for views.
struct CaseContext {
  std::shared_ptr<const cases::OpenCase> open;
  tasks::EntryZone entry_zone;  ///< Entry zone of the task, else the skin around the planned entry.
};

/// Tools that have moved.
struct ToolContext {
  std::shared_ptr<const ToolsShown> tools;    ///< For simulated imaging, which shows the same as a real scanner.
  std::shared_ptr<const ToolsShown> visible;  ///< For all other views: without the parts that an exam hides.
  const cases::OpenCase& open;
};

/// Expert paths of the case, in P.
struct ExpertPaths {
  Segment path_P;                 ///< The one that the views show as the path: the plan, or the nearest to an attempt.
  std::vector<Segment> others_P;  ///< Drawn faint.
};

/// One frame of the window.
struct FrameContext {
  double now_s = 0.0;  ///< Time of any steady clock.
  std::size_t number = 0;
  bool are_tools_moving = false;
};

/// Shared state of the views of one workspace. It outlives them.
class ViewContext : public QObject {
  Q_OBJECT

 public:
  PatientView* main_3d_view = nullptr;  ///< View of the structure panel. Set by the 3D view.
  std::vector<const PatientView*> all_3d_views;
  /// Returns the newest image, which the 3D views show; nullptr before the first. Set by the ultrasound view.
  std::function<std::shared_ptr<const ultrasound::ScanPicture>()> ultrasound_picture = [] { return nullptr; };

 Q_SIGNALS:
  /// The user has changed the crosshairs or the HU window of a slice: all slices follow.
  void focus_moved(const trocar::Vec3& p_P);
  void window_changed(double centre_hu, double width_hu);
};

/// A view of the workspace: a widget of a case and its callbacks. The workspace calls open() for each case, the other
/// functions for changes and once per frame. Its dock owns the widget.
class View {
 public:
  View() = default;
  virtual ~View() = default;
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  virtual QWidget& widget() = 0;
  /// A line with name and figures for the title of the dock; nullptr: the title's text.
  virtual QWidget* title_line() { return nullptr; }
  /// A button in the dock's title; nullptr: none.
  virtual QWidget* title_button() { return nullptr; }

  /// Returns false if it took no time, so that the next view can open in the same frame.
  virtual bool open(const CaseContext&) { return false; }
  /// Called once per frame while a case is open, also before an attempt: takes data that have become ready.
  virtual void take_later_data() {}
  /// Shows the guidance that the mode permits.
  virtual void show_help(TrainingMode) {}
  /// Replaces the paths of the case.
  virtual void show_expert_paths(const ExpertPaths&) {}
  /// In an exam, the view must not show the depth of the tip.
  virtual void set_tip_hidden(bool /*is_hidden*/) {}
  /// Called only after a visible movement.
  virtual void show_tools(const ToolContext&) {}
  /// Called once per frame, for all views before the first draw().
  virtual void update(const FrameContext&) {}
  virtual void draw(const FrameContext&) {}
};

}  // namespace trocar::trainer
