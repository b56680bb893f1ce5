#include "workspace/workspace.h"

#include <QDockWidget>
#include <QHBoxLayout>
#include <QLabel>
#include <QSettings>
#include <QTimer>
#include <QToolButton>
#include <utility>

#include "ui_kit/parts.h"
#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

constexpr double kEntryZone_mm = 10.0;
/// So that all layouts fit next to the tissue panel on a screen of 1024x768.
constexpr QSize kLeastView(130, 100);

/// A slim title with the button of the view and buttons to undock and to hide it.
QWidget* make_title(QDockWidget& dock, QWidget& line, QWidget* view_button) {
  auto* bar = new QFrame;
  bar->setProperty("role", "bar");
  auto* row = new QHBoxLayout(bar);
  row->setContentsMargins(0, 0, 2, 0);
  row->setSpacing(2);
  row->addWidget(&line, 1);
  if (view_button != nullptr) row->addWidget(view_button);
  const auto add = [&](const QString& text, const QString& tooltip) {
    auto* button = new QToolButton;
    button->setText(text);
    button->setToolTip(tooltip);
    button->setAutoRaise(true);
    button->setFocusPolicy(Qt::NoFocus);
    button->setStyleSheet(
        QStringLiteral("QToolButton { border: none; background: transparent; padding: 0 5px; color: %1; }"
                       "QToolButton:hover { color: %2; }")
            .arg(theme().dim.name(), theme().accent.name()));
    row->addWidget(button);
    return button;
  };
  QObject::connect(add(QStringLiteral("❐"), Workspace::tr("Undock the view, or dock it again")), &QToolButton::clicked,
                   &dock, [&dock] { dock.setFloating(!dock.isFloating()); });
  QObject::connect(add(QStringLiteral("✕"), Workspace::tr("Hide the view; show it again with the menu Views")),
                   &QToolButton::clicked, &dock, &QDockWidget::hide);
  return bar;
}

}  // namespace

Workspace::Workspace(ViewRegistry registry, QWidget* parent)
    : QMainWindow(parent), registry_(std::move(registry)), layouts_(layouts_of(registry_)) {
  setObjectName(QStringLiteral("workspace"));
  setDockNestingEnabled(true);
  setDockOptions(QMainWindow::AllowNestedDocks | QMainWindow::AllowTabbedDocks);
  for (const ViewDescription& description : registry_.views()) add_view(description);
  choose_layout(QSettings().value(QStringLiteral("desk/layout"), layouts_.front().name).toString());
}

Workspace::~Workspace() = default;

void Workspace::add_view(const ViewDescription& description) {
  View& view = *views_.emplace_back(description.make(context_));
  auto* dock = new QDockWidget(description.title, this);
  dock->setObjectName(QStringLiteral("dock-") + description.id);
  QWidget* line = view.title_line();
  if (line == nullptr) {
    line = make_label(description.title, "dim");
    line->setContentsMargins(8, 1, 0, 1);
  }
  dock->setTitleBarWidget(make_title(*dock, *line, view.title_button()));
  if (!description.is_panel) view.widget().setMinimumSize(kLeastView);
  dock->setWidget(&view.widget());
  addDockWidget(Qt::LeftDockWidgetArea, dock);
  dock->hide();  // the layout decides
  docks_[description.id] = dock;
  const auto note = [this] { QTimer::singleShot(0, this, &Workspace::note_shares); };
  connect(dock, &QDockWidget::dockLocationChanged, this, note);
  connect(dock, &QDockWidget::topLevelChanged, this, note);
}

QWidget* Workspace::find_widget(const QString& id) const {
  const auto dock = docks_.find(id);
  return dock == docks_.end() ? nullptr : dock->second->widget();
}

void Workspace::show_case(std::shared_ptr<const cases::OpenCase> open) {
  begin_case(std::move(open));
  while (show_part()) {
  }
}

void Workspace::begin_case(std::shared_ptr<const cases::OpenCase> open) {
  const cases::Case& the_case = open->the_case;
  case_.entry_zone = the_case.task.entry_zone.value_or(tasks::EntryZone{the_case.plan.line_P.a, kEntryZone_mm});
  case_.open = std::move(open);
  tools_.reset();
  parts_shown_ = 0;
}

bool Workspace::show_part() {
  while (parts_shown_ < views_.size())
    if (views_[parts_shown_++]->open(case_)) return true;
  return false;
}

void Workspace::take_later_data() {
  for (const auto& view : views_) view->take_later_data();
}

void Workspace::show_help(TrainingMode mode) {
  for (const auto& view : views_) view->show_help(mode);
}

void Workspace::show_expert_paths(const ExpertPaths& paths) {
  for (const auto& view : views_) view->show_expert_paths(paths);
}

void Workspace::set_tip_hidden(bool is_hidden) {
  is_tip_hidden_ = is_hidden;
  tools_.reset();
  for (const auto& view : views_) view->set_tip_hidden(is_hidden);
}

void Workspace::show_tools(ToolsShown tools) {
  frame_.are_tools_moving = tools.are_moving;
  if (tools_ && look_same(tools, *tools_)) return;
  tools_ = std::make_shared<const ToolsShown>(std::move(tools));
  const auto visible = is_tip_hidden_ ? std::make_shared<const ToolsShown>(seen_from_outside(*tools_)) : tools_;
  for (const auto& view : views_) view->show_tools({tools_, visible, *case_.open});
}

void Workspace::draw(double now_s) {
  take_later_data();
  frame_.now_s = now_s;
  ++frame_.number;
  for (const auto& view : views_) view->update(frame_);
  for (const auto& view : views_) view->draw(frame_);
}

}  // namespace trocar::trainer
