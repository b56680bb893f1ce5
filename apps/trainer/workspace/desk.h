#pragma once

#include <QMainWindow>
#include <QSizeF>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cases/open_case.h"
#include "geometry/pose.h"
#include "geometry/segment.h"
#include "shell/seat_choice.h"

class QDockWidget;
class QMenu;

namespace trocar::trainer {

class ForcePlot;
struct LayoutColumn;
class PatientView;
class SliceMarks;
class SliceView;
class StructurePanel;
class UltrasoundControls;
class UltrasoundView;

/// Where the tools are in one frame. Frame P.
struct ToolsShown {
  std::vector<Vec3> shaft_P;        ///< Hub to tip; empty: no needle.
  Pose X_PN;                        ///< Of the needle's tip.
  std::optional<Segment> hand_P;    ///< Where the hand holds the needle, when it is ahead of it.
  std::optional<Segment> stylet_P;  ///< Of a gun, ahead of its cannula.
  std::optional<Segment> core_P;    ///< Where a core was taken.
  std::optional<Pose> X_PT;         ///< Transducer.
  std::optional<Vec3> focus_P;      ///< What the slices go through.
  double inside_mm = 0.0;           ///< Length of the needle in the body.
  bool are_moving = false;
};

/// All views of a case in dockable layouts, which are stored. Keys: Ctrl+1 .. Ctrl+4 select a layout.
class Desk : public QMainWindow {
  Q_OBJECT

 public:
  explicit Desk(QWidget* parent = nullptr);

  void show_case(std::shared_ptr<const cases::OpenCase> open);
  /// The same in parts, each short enough for one frame: show_part() shows the next one; returns false when complete.
  void begin_case(std::shared_ptr<const cases::OpenCase> open);
  bool show_part();
  /// Of the plan, in all views; the structure panel and the keys of the views show no more than that.
  void show_help(Difficulty difficulty);
  /// Hidden: slices and 3D show the needle up to the skin alone, slices do not follow it, and the plot tells no depth.
  /// The ultrasound shows what a scanner shows. The cross-hairs are put into the middle of the body.
  void set_tip_hidden(bool is_hidden);
  void show_tools(const ToolsShown& tools);
  /// Draws what has changed; once a frame. `now_s`: any steady clock.
  void draw(double now_s);

  PatientView& view_3d() noexcept { return *view_3d_; }
  UltrasoundView& ultrasound() noexcept { return *ultrasound_; }
  ForcePlot& forces() noexcept { return *forces_; }

  static const std::vector<QString>& layouts();
  QString layout_name() const { return layout_; }
  void choose_layout(const QString& name);
  void reset_layout();
  void save_layout() const;
  /// Layouts and views to show or hide.
  void fill_menu(QMenu& menu);
  /// Least width (pixels) of the views that are shown.
  int needed_width() const;

 Q_SIGNALS:
  void layout_chosen();

 protected:
  void resizeEvent(QResizeEvent* event) override;
  bool event(QEvent* event) override;

 private:
  /// A view that has a strip of its own lends it to the title.
  void add_view(const char* name, const QString& title, QWidget& view, QWidget* strip = nullptr);
  void arrange(const QString& layout);
  void arrange_rows(const LayoutColumn& column, double width_share);
  void note_shares();
  void fit_to_shares();
  void add_to_menu(QMenu& menu, const QString& name, QDockWidget& dock);
  void add_knobs_button();
  void connect_views();
  void show_in_space(PatientView& view);
  void show_in_slices();
  void follow_with_slices();
  void draw_in_space();
  void show_picture_in_space();

  PatientView* view_3d_ = nullptr;
  PatientView* side_ = nullptr;
  std::vector<SliceView*> slices_;  ///< Axial, coronal, sagittal, along, across the needle.
  std::vector<SliceMarks*> marks_;  ///< Over them.
  StructurePanel* structures_ = nullptr;
  UltrasoundView* ultrasound_ = nullptr;
  UltrasoundControls* ultrasound_controls_ = nullptr;
  ForcePlot* forces_ = nullptr;
  std::map<QString, QDockWidget*> docks_;
  QString layout_;
  std::map<QString, QSizeF> shares_;  ///< Of the desk's size, by view; of a hidden view the last one.
  bool is_arranging_ = false;         ///< The program moves the docks, not a person.
  std::shared_ptr<const cases::OpenCase> open_;
  bool is_tip_hidden_ = false;
  std::optional<ToolsShown> tools_;   ///< Of the last frame.
  ToolsShown shown_;                  ///< What slices and 3D may show of them.
  std::uint64_t picture_number_ = 0;  ///< Of the one in the 3D views.
  bool has_whole_picture_ = false;    ///< It is in full detail.
  bool are_moving_ = false;
  unsigned stale_slices_ = 0;  ///< A bit a slice that has not seen the tools yet.
  std::size_t frame_ = 0;
  bool has_side_patient_ = false;
  int parts_shown_ = 0;  ///< Of the case.
};

}  // namespace trocar::trainer
