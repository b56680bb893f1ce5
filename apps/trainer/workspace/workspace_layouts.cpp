// Layouts of the workspace: selection, storage and adaptation to the window.
#include <QAction>
#include <QDockWidget>
#include <QEvent>
#include <QLayout>
#include <QMenu>
#include <QSettings>
#include <QTimer>
#include <algorithm>

#include "workspace/layouts.h"
#include "workspace/workspace.h"

namespace trocar::trainer {
namespace {

/// Of stored layouts, as in the settings files of users: the state of a layout without a view, or with one that is
/// gone, is still valid.
constexpr int kStateVersion = 10;

/// The group is named "desk" in the settings files of users.
QString settings_key(const QString& layout) {
  return QStringLiteral("desk/") + layout;
}
QString shares_key(const QString& layout) {
  return QStringLiteral("desk/shares/") + layout;
}

}  // namespace

void Workspace::choose_layout(const QString& name) {
  const bool is_known =
      std::any_of(layouts_.begin(), layouts_.end(), [&](const Layout& layout) { return layout.name == name; });
  if (!is_known) return choose_layout(layouts_.front().name);
  if (!layout_.isEmpty()) save_layout();
  layout_ = name;
  QSettings settings;
  settings.setValue(QStringLiteral("desk/layout"), name);
  const QByteArray kept = settings.value(settings_key(name)).toByteArray();
  // First: the views of both layouts together would widen the window.
  for (const auto& [view, dock] : docks_) dock->hide();
  is_arranging_ = true;
  const QVariantMap shares = settings.value(shares_key(name)).toMap();
  if (!shares.isEmpty() && restoreState(kept, kStateVersion)) {
    shares_.clear();
    for (auto share = shares.begin(); share != shares.end(); ++share) shares_[share.key()] = share->toSizeF();
  } else {
    arrange(name);
  }
  fit_to_shares();
  QTimer::singleShot(0, this, [this] { is_arranging_ = false; });
  Q_EMIT layout_chosen();
}

void Workspace::save_layout() const {
  QSettings settings;
  settings.setValue(settings_key(layout_), saveState(kStateVersion));
  QVariantMap shares;
  for (const auto& [view, share] : shares_) shares[view] = share;
  settings.setValue(shares_key(layout_), shares);
}

void Workspace::reset_layout() {
  QSettings().remove(settings_key(layout_));
  QSettings().remove(shares_key(layout_));
  is_arranging_ = true;
  arrange(layout_);
  fit_to_shares();
  QTimer::singleShot(0, this, [this] { is_arranging_ = false; });
}

/// Stores the shares after a user's change (drag, show, hide); a change of the window's size keeps them.
void Workspace::note_shares() {
  if (!isVisible() || is_arranging_) return;
  for (const auto& [view, dock] : docks_) {
    if (dock->isHidden() || dock->isFloating() || dock->visibleRegion().isEmpty()) continue;
    shares_[view] = {static_cast<double>(dock->width()) / width(), static_cast<double>(dock->height()) / height()};
  }
}

/// Always from the same shares, so that sizes do not drift.
void Workspace::fit_to_shares() {
  QList<QDockWidget*> docks;
  QList<int> widths, heights;
  for (const auto& [view, dock] : docks_) {
    const auto share = shares_.find(view);
    if (dock->isHidden() || dock->isFloating() || share == shares_.end()) continue;
    docks << dock;
    widths << std::max(1, qRound(share->second.width() * width()));
    heights << std::max(1, qRound(share->second.height() * height()));
  }
  resizeDocks(docks, widths, Qt::Horizontal);
  resizeDocks(docks, heights, Qt::Vertical);
}

void Workspace::hideEvent(QHideEvent* event) {
  QMainWindow::hideEvent(event);
  if (event->spontaneous()) return;  // minimised
  for (const auto& [view, dock] : docks_) {
    if (!dock->isFloating() || dock->isHidden()) continue;
    dock->hide();
    hidden_floats_.push_back(dock);
  }
}

void Workspace::showEvent(QShowEvent* event) {
  QMainWindow::showEvent(event);
  for (QDockWidget* dock : std::exchange(hidden_floats_, {})) dock->show();
}

void Workspace::resizeEvent(QResizeEvent* event) {
  QMainWindow::resizeEvent(event);
  fit_to_shares();
}

bool Workspace::event(QEvent* event) {
  const bool is_taken = QMainWindow::event(event);
  if (event->type() == QEvent::MouseButtonRelease) note_shares();  // of a border between views
  return is_taken;
}

int Workspace::needed_width() const {
  return layout()->minimumSize().width();
}

void Workspace::arrange(const QString& name) {
  const auto layout = std::find_if(layouts_.begin(), layouts_.end(), [&](const Layout& l) { return l.name == name; });
  // Puts all hidden views into a column on the right: there the menu shows a view that is not in the layout, and the
  // stored layout records that it was hidden.
  for (const auto& [view, dock] : docks_) {
    dock->hide();
    dock->setFloating(false);
    addDockWidget(Qt::RightDockWidgetArea, dock);
  }
  shares_.clear();
  QList<QDockWidget*> column_tops;
  int all_columns = 0;
  for (const LayoutColumn& column : layout->columns) all_columns += column.share;
  // Columns first, so that they extend from top to bottom; then each is split into rows.
  for (const LayoutColumn& column : layout->columns) {
    QDockWidget* top = docks_.at(column.cells.front().views.front());
    if (column_tops.isEmpty())
      addDockWidget(Qt::LeftDockWidgetArea, top);
    else
      splitDockWidget(column_tops.last(), top, Qt::Horizontal);
    top->show();
    column_tops << top;
  }
  for (const LayoutColumn& column : layout->columns)
    arrange_rows(column, static_cast<double>(column.share) / all_columns);
}

void Workspace::arrange_rows(const LayoutColumn& column, double width_share) {
  QList<QDockWidget*> rows;
  int all_cells = 0;
  for (const LayoutCell& cell : column.cells) all_cells += cell.share;
  for (const LayoutCell& cell : column.cells) {
    QDockWidget* first = docks_.at(cell.views.front());
    if (!rows.isEmpty()) splitDockWidget(rows.last(), first, Qt::Vertical);
    first->show();
    rows << first;
  }
  for (const LayoutCell& cell : column.cells) {
    for (const QString& view : cell.views)
      shares_[view] = {width_share / static_cast<double>(cell.views.size()),
                       static_cast<double>(cell.share) / all_cells};
    for (std::size_t v = 1; v < cell.views.size(); ++v) {
      splitDockWidget(docks_.at(cell.views[v - 1]), docks_.at(cell.views[v]), Qt::Horizontal);
      docks_.at(cell.views[v])->show();
    }
  }
}

void Workspace::fill_menu(QMenu& menu) {
  const std::vector<QKeySequence> keys = keys_of(Action::kLayout);
  std::size_t number = 0;
  for (const Layout& layout : layouts_) {
    QAction* action = menu.addAction(tr("Layout: %1").arg(tr(layout.name.toLatin1().constData())));
    if (number < keys.size()) action->setShortcut(keys[number++]);
    connect(action, &QAction::triggered, this, [this, name = layout.name] { choose_layout(name); });
  }
  QAction* reset = menu.addAction(tr("Reset layout"));
  connect(reset, &QAction::triggered, this, &Workspace::reset_layout);
  menu.addSeparator();
  for (const auto& [id, dock] : docks_) add_to_menu(menu, id, *dock);
  for (const ViewDescription& view : registry_.views())
    if (auto* action = menu.findChild<QAction*>(QStringLiteral("show-") + view.id); view.toggled_by)
      action->setShortcut(key_of(*view.toggled_by));
}

/// Qt's own action hides a view behind the tab of another.
void Workspace::add_to_menu(QMenu& menu, const QString& id, QDockWidget& dock) {
  QAction* action = menu.addAction(dock.windowTitle());
  action->setObjectName(QStringLiteral("show-") + id);
  action->setCheckable(true);
  const auto is_seen = [this, &dock] { return !dock.isHidden() && (!isVisible() || !dock.visibleRegion().isEmpty()); };
  connect(&menu, &QMenu::aboutToShow, action, [=] { action->setChecked(is_seen()); });
  connect(action, &QAction::triggered, this, [this, &dock, is_seen] {
    const bool was_seen = is_seen();
    dock.setVisible(!was_seen);
    if (!was_seen) dock.raise();
    QTimer::singleShot(0, this, &Workspace::note_shares);
  });
}

}  // namespace trocar::trainer
