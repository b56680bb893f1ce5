#include "shell/main_window.h"

#include <QActionGroup>
#include <QApplication>
#include <QCloseEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QScreen>
#include <QScrollArea>
#include <QSettings>
#include <QShortcut>
#include <QStackedWidget>
#include <QToolButton>
#include <QVBoxLayout>

#include "control/mirror_station.h"
#include "pages/briefing_page.h"
#include "pages/case_page.h"
#include "pages/start_page.h"
#include "pages/work_page.h"
#include "panels/devices/device_test_dialog.h"
#include "panels/status_strip.h"
#include "shell/keys_dialog.h"
#include "shell/trainer_flow.h"
#include "ui_kit/focus_ring.h"
#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "ui_kit/wheel_guard.h"
#include "ui_kit/window_language.h"
#include "workspace/workspace.h"

namespace trocar::trainer {
namespace {

struct Step {
  const char* page;
  const char* title;
};
constexpr Step kPageSteps[] = {{"start", QT_TRANSLATE_NOOP("Table", "Choose")},
                               {"briefing", QT_TRANSLATE_NOOP("Table", "Briefing")},
                               {"puncture", QT_TRANSLATE_NOOP("Table", "Puncture")},
                               {"feedback", QT_TRANSLATE_NOOP("Table", "Feedback")}};

/// Fits a screen of 1024x768 with the bars of a desktop.
constexpr QSize kLeastSize(960, 640);

}  // namespace

MainWindow::MainWindow(const std::filesystem::path& state_folder, const database::DatabaseUrl& results, QWidget* parent)
    : QMainWindow(parent) {
  setObjectName(QStringLiteral("main-window"));
  qApp->installEventFilter(new WheelGuard(this));  // before any control is made
  setWindowTitle(tr("Trocar"));
  auto* central = new QWidget;
  auto* column = new QVBoxLayout(central);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  pages_ = new QStackedWidget;
  start_ = new StartPage;
  briefing_ = new BriefingPage;
  work_ = new WorkPage;
  case_ = new CasePage;
  for (QWidget* page : std::initializer_list<QWidget*>{start_, briefing_, make_scrolled(*case_), work_})
    pages_->addWidget(page);
  strip_ = new StatusStrip;
  column->addWidget(make_top_bar());
  column->addWidget(pages_, 1);
  column->addWidget(strip_);
  pages_->setMinimumSize(1, 1);  // no page pushes the strip out of the window
  setCentralWidget(central);
  banner_ = new Banner(*central);
  add_shortcuts();
  new FocusRing(this);
  mirror_ = new MirrorStation(*this);
  mirror_->fill_menu(*views_menu_);
  flow_ = new TrainerFlow(*this, state_folder, results);
  // A page that needs more space is scrolled, so that the strip at the bottom is always visible.
  setMinimumSize(kLeastSize);
  resize(QSize(1280, 800).boundedTo(screen()->availableSize()));
  restoreGeometry(QSettings().value(QStringLiteral("window/geometry")).toByteArray());
  show_page(QStringLiteral("start"));
}

MainWindow::~MainWindow() {
  flow_->close();
}

QWidget* MainWindow::make_top_bar() {
  auto* bar = new QFrame;
  bar->setProperty("role", "bar");
  auto* row = new QHBoxLayout(bar);
  row->setContentsMargins(16, 6, 8, 6);
  row->setSpacing(8);
  row->addWidget(make_label(QStringLiteral("Trocar"), "brand"));
  row->addSpacing(12);
  for (const Step& step : kPageSteps) {
    if (!steps_.empty()) row->addWidget(make_label(QStringLiteral("›"), "dim"));
    auto* label = make_label(tr(step.title), "dim");
    label->setObjectName(QStringLiteral("step-") + QString::fromLatin1(step.page));
    label->setToolTip(tr("Current step, from the start page to the feedback"));
    steps_.push_back(label);
    row->addWidget(label);
  }
  row->addStretch();
  auto* views = make_tool_button("views-menu", tr("Views"), tr("Layouts and visible views"));
  views_menu_ = new QMenu(views);
  work_->workspace().fill_menu(*views_menu_);
  fill_text_menu(*views_menu_->addMenu(tr("Text size")));
  fill_language_menu(*views_menu_->addMenu(tr("Language")));
  add_sound(*views_menu_);
  views_menu_->addSeparator();
  views->setMenu(views_menu_);
  views->setPopupMode(QToolButton::InstantPopup);
  auto* tissues = make_tool_button("open-parameters", tr("Tissues"), Action::kTissues);
  auto* builder = make_tool_button("open-case-builder", tr("Case builder"), Action::kCaseBuilder);
  auto* keys = make_tool_button("open-keys", tr("Keys"), Action::kKeys);
  for (QToolButton* button : {views, tissues, builder, keys}) row->addWidget(button);
  connect(tissues, &QToolButton::clicked, this, [this] {
    if (!work_->toggle_parameters())
      show_message(
          tr("The Tissues panel is closed in an exam: it shows path, depths and forces, and changes the task."),
          BannerKind::kWarning);
  });
  connect(builder, &QToolButton::clicked, this,
          [this] { page_ == QLatin1String("case-builder") ? flow_->go_to_start() : flow_->go_to_case_builder(); });
  connect(keys, &QToolButton::clicked, this, [this] { show_keys(this); });
  return bar;
}

void MainWindow::add_sound(QMenu& menu) {
  const QString key = QStringLiteral("sound/is_on");
  menu.addSeparator();
  sound_ = menu.addAction(tr("Biopsy gun sound"));
  sound_->setObjectName(QStringLiteral("sound"));
  sound_->setCheckable(true);
  sound_->setChecked(QSettings().value(key, true).toBool());
  connect(sound_, &QAction::toggled, this, [key](bool is_on) { QSettings().setValue(key, is_on); });
}

bool MainWindow::has_sound() const {
  return sound_->isChecked();
}

void MainWindow::fill_language_menu(QMenu& menu) {
  auto* group = new QActionGroup(&menu);
  const auto add = [&](const QString& name, const QString& code) {
    QAction* action = group->addAction(name);
    action->setObjectName(QStringLiteral("language-") + (code.isEmpty() ? QStringLiteral("desktop") : code));
    action->setCheckable(true);
    action->setChecked(code == chosen_language());
    menu.addAction(action);
    connect(action, &QAction::triggered, this, [this, code] {
      choose_language(code);
      show_message(tr("The language changes when you open the window next time."), BannerKind::kSuccess);
    });
  };
  add(tr("As the desktop"), {});
  for (const language::LanguageEntry& entry : language::list_languages()) add(to_qt(entry.name), to_qt(entry.code));
}

void MainWindow::fill_text_menu(QMenu& menu) {
  auto* sizes = new QActionGroup(&menu);
  for (const int percent : kTextPercents) {
    QAction* action = sizes->addAction(tr("%1 %").arg(percent));
    action->setObjectName(QStringLiteral("text-size-%1").arg(percent));
    action->setCheckable(true);
    action->setChecked(percent == kept_text_percent());
    menu.addAction(action);
    connect(action, &QAction::triggered, this, [percent] { choose_text_percent(percent); });
  }
  const auto step = [sizes](int by) {
    const auto actions = sizes->actions();
    const auto next = actions.indexOf(sizes->checkedAction()) + by;
    if (next >= 0 && next < actions.size()) actions[next]->trigger();
  };
  menu.addSeparator();
  const auto add = [&](const QString& text, Action of_table, int by) {
    QAction* action = menu.addAction(text);
    action->setShortcut(key_of(of_table));
    connect(action, &QAction::triggered, this, [step, by] { step(by); });
  };
  add(tr("Larger"), Action::kLargerText, 1);
  add(tr("Smaller"), Action::kSmallerText, -1);
}

void MainWindow::add_shortcuts() {
  auto* full_screen = new QShortcut(key_of(Action::kFullScreen), this);
  connect(full_screen, &QShortcut::activated, this, [this] { isFullScreen() ? showNormal() : showFullScreen(); });
}

void MainWindow::show_page(const QString& name) {
  page_ = name;
  QWidget* page = start_;
  if (name == QLatin1String("briefing")) page = briefing_;
  if (name == QLatin1String("puncture") || name == QLatin1String("feedback")) page = work_;
  if (name == QLatin1String("case-builder")) page = case_;
  for (int n = 0; n < pages_->count(); ++n)
    if (pages_->widget(n) == page || pages_->widget(n)->isAncestorOf(page)) pages_->setCurrentIndex(n);
  for (QLabel* step : steps_) {
    const bool is_here = step->objectName() == QStringLiteral("step-") + name;
    step->setStyleSheet(is_here ? QStringLiteral("color: %1; font-weight: 600;").arg(theme().text.name()) : QString());
  }
  page->setFocus();
  banner_->place();
}

void MainWindow::show_banner(const QString& text, BannerKind kind) {
  banner_->set_state(text, kind);
}

void MainWindow::show_message(const QString& text, BannerKind kind) {
  banner_->show_message(text, kind);
}

QVariantMap MainWindow::facts() const {
  QVariantMap facts = flow_->facts();
  if (const auto* test = findChild<DeviceTestDialog*>()) facts.insert(test->facts());
  facts[QStringLiteral("page")] = page_;
  facts[QStringLiteral("banner")] = banner_->isVisible() ? banner_->text() : QString();
  facts[QStringLiteral("is_tissues_open")] = work_->are_parameters_shown();
  facts[QStringLiteral("layout")] = work_->workspace().layout_name();
  facts[QStringLiteral("mirror")] = static_cast<int>(mirror_->settings().axis);
  facts[QStringLiteral("columns")] = width();
  facts[QStringLiteral("rows")] = height();
  return facts;
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (!flow_->may_close()) return event->ignore();
  QSettings().setValue(QStringLiteral("window/geometry"), saveGeometry());
  work_->workspace().save_layout();
  flow_->close();
  QMainWindow::closeEvent(event);
}

}  // namespace trocar::trainer
