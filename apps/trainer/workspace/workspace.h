#pragma once

#include <QMainWindow>
#include <QSizeF>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "cases/open_case.h"
#include "choice/training_mode.h"
#include "views/tools_shown.h"
#include "views/view.h"
#include "views/view_registry.h"
#include "workspace/layouts.h"
#include "workspace/standard_views.h"

class QDockWidget;
class QMenu;

namespace trocar::trainer {

/// All views of a case in dockable layouts, which are stored. It accesses views only through their ViewDescription:
/// only the registry names them. Keys: Ctrl+1 .. Ctrl+4 select a layout.
class Workspace : public QMainWindow {
  Q_OBJECT

 public:
  explicit Workspace(ViewRegistry registry = standard_views(), QWidget* parent = nullptr);
  ~Workspace() override;

  void show_case(std::shared_ptr<const cases::OpenCase> open);
  /// Shows a case in parts, each short enough for one frame: show_part() shows the next one; returns false when
  /// complete.
  void begin_case(std::shared_ptr<const cases::OpenCase> open);
  bool show_part();
  /// Called once per frame while a case is open: the views take data that have become ready.
  void take_later_data();
  /// Sets the guidance in all views; panels and keys of the views cannot show more.
  void show_help(TrainingMode mode);
  /// Replaces the planned path in all views until the next call or case.
  void show_expert_paths(const ExpertPaths& paths);
  /// Hidden: slices and 3D show the needle up to the skin only, slices do not follow it, and the plot has no depth. The
  /// ultrasound is not changed, as in a real scanner. The crosshairs are moved to the middle of the body.
  void set_tip_hidden(bool is_hidden);
  void show_tools(ToolsShown tools);
  /// Draws the changed views; call once per frame. `now_s`: time of any steady clock.
  void draw(double now_s);

  /// The widget of a view, or a part of it, by its type: find<ForcePlot>("forces"); nullptr if there is none.
  template <class Widget>
  Widget* find(const char* id) const {
    QWidget* widget = find_widget(QString::fromLatin1(id));
    auto* own = qobject_cast<Widget*>(widget);
    return own != nullptr || widget == nullptr ? own : widget->findChild<Widget*>();
  }
  const ViewRegistry& registry() const noexcept { return registry_; }

  const std::vector<Layout>& layouts() const noexcept { return layouts_; }
  QString layout_name() const { return layout_; }
  void choose_layout(const QString& name);
  void reset_layout();
  void save_layout() const;
  /// Layouts and views to show or hide.
  void fill_menu(QMenu& menu);
  /// Minimum width (pixels) of the visible views.
  int needed_width() const;

 Q_SIGNALS:
  void layout_chosen();

 protected:
  void resizeEvent(QResizeEvent* event) override;
  /// Floating views are windows of their own: they are hidden and shown with this page.
  void hideEvent(QHideEvent* event) override;
  void showEvent(QShowEvent* event) override;
  bool event(QEvent* event) override;

 private:
  void add_view(const ViewDescription& description);
  QWidget* find_widget(const QString& id) const;
  void arrange(const QString& layout);
  void arrange_rows(const LayoutColumn& column, double width_share);
  void note_shares();
  void fit_to_shares();
  void add_to_menu(QMenu& menu, const QString& id, QDockWidget& dock);

  ViewRegistry registry_;
  std::vector<Layout> layouts_;
  ViewContext context_;
  std::vector<std::unique_ptr<View>> views_;  ///< In the order of the registry.
  std::map<QString, QDockWidget*> docks_;
  QString layout_;
  std::map<QString, QSizeF> shares_;  ///< Shares of the workspace's size, by view; the last value for a hidden view.
  std::vector<QDockWidget*> hidden_floats_;  ///< Floating views that are hidden with the page.
  bool is_arranging_ = false;                ///< The program moves the docks, not the user.
  CaseContext case_;
  bool is_tip_hidden_ = false;
  std::shared_ptr<const ToolsShown> tools_;  ///< Tools of the last frame; null: none yet.
  FrameContext frame_;
  std::size_t parts_shown_ = 0;  ///< Views that have opened the case.
};

}  // namespace trocar::trainer
