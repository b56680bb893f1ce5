#include "shell/main_window.h"

#include <QApplication>
#include <QCloseEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QSettings>
#include <QShortcut>
#include <QStackedWidget>
#include <QToolButton>
#include <QVBoxLayout>

#include "control/seat_flow.h"
#include "desk/desk.h"
#include "pages/briefing_page.h"
#include "pages/case_page.h"
#include "pages/start_page.h"
#include "pages/work_page.h"
#include "shell/focus_ring.h"
#include "shell/keys_dialog.h"
#include "shell/parts.h"
#include "shell/status_strip.h"
#include "shell/theme.h"
#include "shell/wheel_guard.h"

namespace trocar::trainer {
namespace {

struct Step {
  const char* page;
  const char* title;
};
constexpr Step kSteps[] = {
    {"start", "Choose"}, {"briefing", "Briefing"}, {"puncture", "Puncture"}, {"feedback", "Feedback"}};

}  // namespace

MainWindow::MainWindow(const std::filesystem::path& state_folder, QWidget* parent) : QMainWindow(parent) {
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
  for (QWidget* page : std::initializer_list<QWidget*>{start_, briefing_, work_, case_}) pages_->addWidget(page);
  strip_ = new StatusStrip;
  column->addWidget(make_top_bar());
  column->addWidget(pages_, 1);
  column->addWidget(strip_);
  setCentralWidget(central);
  banner_ = new Banner(*central);
  add_shortcuts();
  new FocusRing(this);
  flow_ = new SeatFlow(*this, state_folder);
  resize(1280, 800);
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
  auto* name = make_label(QStringLiteral("Trocar"));
  name->setFont(scaled_font(1.35, true));
  row->addWidget(name);
  row->addSpacing(24);
  for (const Step& step : kSteps) {
    auto* label = make_label(tr(step.title), "badge");
    label->setObjectName(QStringLiteral("step-") + QString::fromLatin1(step.page));
    steps_.push_back(label);
    row->addWidget(label);
  }
  row->addStretch();
  auto* views = make_tool_button("views-menu", tr("Views"), tr("Layouts, and which views are shown"));
  auto* menu = new QMenu(views);
  work_->desk().fill_menu(*menu);
  add_sound(*menu);
  views->setMenu(menu);
  views->setPopupMode(QToolButton::InstantPopup);
  auto* tissues = make_tool_button("open-parameters", tr("Tissues"), tr("Tissue parameters and the predicted force"),
                                   QStringLiteral("Ctrl+T"));
  auto* builder = make_tool_button("open-case-builder", tr("Case builder"), tr("Makes cases from CT and labels"),
                                   QStringLiteral("Ctrl+B"));
  auto* keys = make_tool_button("open-keys", tr("Keys"), tr("All keys and mouse actions"), QStringLiteral("F1"));
  for (QToolButton* button : {views, tissues, builder, keys}) row->addWidget(button);
  connect(tissues, &QToolButton::clicked, this, [this] { work_->toggle_parameters(); });
  connect(builder, &QToolButton::clicked, this,
          [this] { page_ == QLatin1String("case-builder") ? flow_->go_to_start() : flow_->go_to_case_builder(); });
  connect(keys, &QToolButton::clicked, this, [this] { show_keys(this); });
  return bar;
}

void MainWindow::add_sound(QMenu& menu) {
  const QString key = QStringLiteral("sound/is_on");
  menu.addSeparator();
  sound_ = menu.addAction(tr("Sound of the gun"));
  sound_->setObjectName(QStringLiteral("sound"));
  sound_->setCheckable(true);
  sound_->setChecked(QSettings().value(key, true).toBool());
  connect(sound_, &QAction::toggled, this, [key](bool is_on) { QSettings().setValue(key, is_on); });
}

bool MainWindow::has_sound() const {
  return sound_->isChecked();
}

void MainWindow::add_shortcuts() {
  auto* full_screen = new QShortcut(QKeySequence(QStringLiteral("F11")), this);
  connect(full_screen, &QShortcut::activated, this, [this] { isFullScreen() ? showNormal() : showFullScreen(); });
}

void MainWindow::show_page(const QString& name) {
  page_ = name;
  QWidget* page = start_;
  if (name == QLatin1String("briefing")) page = briefing_;
  if (name == QLatin1String("puncture") || name == QLatin1String("feedback")) page = work_;
  if (name == QLatin1String("case-builder")) page = case_;
  pages_->setCurrentWidget(page);
  for (QLabel* step : steps_) {
    const bool is_here = step->objectName() == QStringLiteral("step-") + name;
    step->setStyleSheet(is_here ? QStringLiteral("background: %1; color: %2; font-weight: 600;")
                                      .arg(theme().accent.name(), theme().ground.name())
                                : QString());
  }
  page->setFocus();
  banner_->place();
}

void MainWindow::show_banner(const QString& text, BannerKind kind) {
  banner_->set_state(text, kind);
}

void MainWindow::tell(const QString& text, BannerKind kind) {
  banner_->tell(text, kind);
}

QVariantMap MainWindow::facts() const {
  QVariantMap facts = flow_->facts();
  facts[QStringLiteral("page")] = page_;
  facts[QStringLiteral("banner")] = banner_->isVisible() ? banner_->text() : QString();
  facts[QStringLiteral("layout")] = work_->desk().layout_name();
  facts[QStringLiteral("columns")] = width();
  facts[QStringLiteral("rows")] = height();
  return facts;
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (!flow_->may_close()) return event->ignore();
  QSettings().setValue(QStringLiteral("window/geometry"), saveGeometry());
  work_->desk().save_layout();
  flow_->close();
  QMainWindow::closeEvent(event);
}

}  // namespace trocar::trainer
