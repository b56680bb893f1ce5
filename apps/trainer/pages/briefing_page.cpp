#include "pages/briefing_page.h"

#include <QImage>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QVBoxLayout>
#include <algorithm>
#include <span>

#include "anatomy/phantom/phantom.h"
#include "attempt/live/live_attempt.h"
#include "attempt/servers/device_control.h"
#include "attempt/servers/tool_devices.h"
#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "views/slices/briefing_picture.h"

namespace trocar::trainer {
namespace {

constexpr int kSteps = 1000;

struct Control {
  const char* with;
  const char* does;
};
constexpr Control kTakeMouse[] = {{"A / S", "select the needle / the transducer"},
                                  {"drag", "move along the skin; right button: tilt"},
                                  {"wheel", "advance and withdraw; Shift: fine steps"},
                                  {"H", "move the active tool to its planned position (guided)"}};
constexpr Control kNeedleByGamepad[] = {{"left stick", "moves the needle; cross: lifts and lowers it"},
                                        {"right stick", "swings the tip in the direction of the stick"},
                                        {"triggers", "right: push in, left: pull out; rumble: resistance"},
                                        {"shoulders", "turn the bevel"}};
constexpr Control kProbeByGamepad[] = {{"left stick", "moves the transducer; cross: lifts and lowers it"},
                                       {"right stick", "tilts it"},
                                       {"shoulders", "turn it"}};
constexpr Control kProbeByMouse[] = {{"S, mouse", "drag and wheel move the transducer"}};
constexpr Control kNeedleByMouse[] = {{"A, mouse", "drag and wheel move the needle; Shift: finely"}};
constexpr Control kAlways[] = {
    {"Enter", "fire the biopsy gun"}, {"E", "end the attempt"}, {"Space", "stop all forces"}, {"F1", "all keys"}};

QString row(const QString& with, const QString& does) {
  return QStringLiteral("<tr><td><b>%1</b></td><td>%2</td></tr>").arg(with.toHtmlEscaped(), does);
}

QString rows(std::span<const Control> controls) {
  QString all;
  for (const Control& control : controls) all += row(BriefingPage::tr(control.with), BriefingPage::tr(control.does));
  return all;
}

/// Rows for devices other than the mouse.
QString device_rows(const std::string& device, bool is_needle) {
  if (device == "gamepad") return is_needle ? rows(kNeedleByGamepad) : rows(kProbeByGamepad);
  const QString tool = is_needle ? BriefingPage::tr("needle") : BriefingPage::tr("transducer");
  if (device == "spacemouse")
    return row(BriefingPage::tr("cap"), BriefingPage::tr("push and turn it to move and turn the %1").arg(tool));
  return row(to_qt(attempt::device_title(device)), BriefingPage::tr("its stylus is the %1").arg(tool));
}

QString controls_text(const TrainerChoice& choice) {
  const bool is_needle_led = attempt::follows_targets(choice.needle_device);
  const bool is_probe_led = attempt::follows_targets(choice.probe_device);
  QString all;
  if (is_needle_led && is_probe_led) {
    all = rows(kTakeMouse);
  } else {
    all += is_needle_led ? rows(kNeedleByMouse) : device_rows(choice.needle_device, true);
    all += is_probe_led ? rows(kProbeByMouse) : device_rows(choice.probe_device, false);
  }
  return QStringLiteral("<table cellspacing='0' cellpadding='3'>") + all + rows(kAlways) + QStringLiteral("</table>");
}

QString risks_text(const tasks::Task& task) {
  QStringList risks;
  for (const tasks::RiskStructure& risk : task.risks)
    risks << BriefingPage::tr("%1 (−%2)")
                 .arg(to_qt(risk.label.empty() ? risk.tissue : risk.label))
                 .arg(risk.penalty, 0, 'f', 0);
  return risks.join(QStringLiteral(", "));
}

QString counts_text(const cases::Case& the_case) {
  const tasks::Task& task = the_case.task;
  return BriefingPage::tr(
             "Scoring: tip at the target (half of the points at %1 mm), entry point (half at %2 mm) and angle (half at "
             "%3°) compared with the expert's, %6a short path, less than %4 s. Do not touch: %5.")
      .arg(task.target_tolerance_mm, 0, 'f', 0)
      .arg(task.entry_tolerance_mm, 0, 'f', 0)
      .arg(task.angle_tolerance_deg, 0, 'f', 0)
      .arg(task.time_limit_s, 0, 'f', 0)
      .arg(risks_text(task), the_case.needle.is_biopsy ? BriefingPage::tr("target tissue in the core, ") : QString());
}

/// The referral of an embedded patient; empty for others.
QString referral_text(const cases::Case& the_case) {
  for (const anatomy::PhantomInfo& info : anatomy::embedded_patients())
    if (info.name == the_case.patient->name && !info.briefing.empty())
      return to_qt(info.briefing) + QStringLiteral("\n\n");
  return {};
}

/// Targets that are no lesion.
QString fluid_goal_text(const tasks::Task& task) {
  const auto is_target = [&](const char* tissue) {
    return std::find(task.target_tissues.begin(), task.target_tissues.end(), tissue) != task.target_tissues.end();
  };
  if (is_target("csf")) return BriefingPage::tr("Bring the needle's tip into the spinal fluid of the dural sac.");
  if (is_target("ascites")) return BriefingPage::tr("Bring the needle's tip into the free fluid of the abdomen.");
  if (is_target("bile_duct")) return BriefingPage::tr("Bring the needle's tip into a bile duct of the liver.");
  return {};
}

QString goal_text(const cases::Case& the_case) {
  if (const QString text = fluid_goal_text(the_case.task); !text.isEmpty()) return text;
  return BriefingPage::tr("Bring the needle's tip to the %1 %2, under ultrasound.")
      .arg(the_case.is_parenchymal ? BriefingPage::tr("healthy tissue of the") : BriefingPage::tr("lesion of the"),
           to_qt(the_case.task.organ));
}

QString way_text(const cases::Case& the_case) {
  return BriefingPage::tr(" The planned path is %1 mm long, %2 mm of it in the %3; nearest structure: %4.")
      .arg(the_case.plan.length_mm, 0, 'f', 0)
      .arg(the_case.plan.organ_path_mm, 0, 'f', 0)
      .arg(to_qt(the_case.task.organ))
      .arg(the_case.plan.nearest_risk.empty()
               ? BriefingPage::tr("no structure at risk")
               : to_qt(the_case.plan.nearest_risk).replace(QLatin1Char(0x5f), QLatin1Char(0x20)));
}

QLabel* paragraph() {
  auto* label = make_label({});
  label->setWordWrap(true);
  label->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  return label;
}

}  // namespace

BriefingPage::BriefingPage(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("briefing-page"));
  auto* page = new QVBoxLayout(this);
  page->setContentsMargins(40, 24, 40, 24);
  page->setSpacing(12);
  title_ = make_label({}, "title");
  subtitle_ = make_label({}, "dim");
  page->addWidget(title_);
  page->addWidget(subtitle_);
  auto* columns = new QHBoxLayout;
  columns->setSpacing(16);
  columns->addWidget(make_text(), 5);
  columns->addWidget(make_pictures(), 6);
  page->addLayout(columns, 1);
  page->addWidget(make_bottom());
}

QWidget* BriefingPage::make_text() {
  QBoxLayout* content = nullptr;
  QFrame* card = make_card(tr("Task"), content);
  goal_ = paragraph();
  content->addWidget(goal_);
  content->addWidget(make_label(tr("Scoring"), "heading"));
  counts_ = paragraph();
  content->addWidget(counts_);
  content->addWidget(make_label(tr("Controls"), "heading"));
  controls_ = paragraph();
  content->addWidget(controls_);
  content->addStretch();
  return card;
}

QWidget* BriefingPage::make_pictures() {
  QBoxLayout* content = nullptr;
  QFrame* card = make_card(tr("Target location"), content);
  auto* pictures = new QVBoxLayout;
  for (QLabel** label : {&axial_, &second_}) {
    *label = make_label({}, "dim");
    (*label)->setAlignment(Qt::AlignCenter);
    (*label)->setMinimumSize(240, 160);
    (*label)->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Ignored);
    pictures->addWidget(*label, 1);
  }
  content->addLayout(pictures, 1);
  return card;
}

QWidget* BriefingPage::make_bottom() {
  auto* bottom = new QWidget;
  auto* row = new QHBoxLayout(bottom);
  row->setContentsMargins(0, 0, 0, 0);
  auto* back = make_button("back", tr("Back"), tr("Back to the start page; cancels opening"), QStringLiteral("Esc"));
  row->addWidget(back);
  state_ = make_label({}, "dim");
  state_->setObjectName(QStringLiteral("opening-state"));
  row->addWidget(state_, 1);
  progress_ = new QProgressBar;
  progress_->setObjectName(QStringLiteral("opening-progress"));
  progress_->setRange(0, kSteps);
  progress_->setFixedWidth(260);
  row->addWidget(progress_);
  begin_ = make_button("begin", tr("Begin"), tr("Starts the haptic servers and the attempt"), QStringLiteral("Return"));
  begin_->setProperty("role", "primary");
  row->addWidget(begin_);
  connect(back, &QPushButton::clicked, this, &BriefingPage::back_requested);
  connect(begin_, &QPushButton::clicked, this, &BriefingPage::begin_requested);
  return bottom;
}

void BriefingPage::show_opening(const TrainerChoice& choice) {
  const QString patient = to_qt(choice.patient).section('/', -1);
  title_->setText(tr("Briefing"));
  subtitle_->setText(tr("Patient %1").arg(patient));
  controls_->setText(controls_text(choice));
  goal_->clear();
  counts_->clear();
  axial_->clear();
  second_->clear();
  begin_->setEnabled(false);
  progress_->show();
  show_progress(tr("Opening the patient"), 0.0);
}

void BriefingPage::show_progress(const QString& step, double fraction) {
  state_->setText(step);
  progress_->setValue(static_cast<int>(kSteps * fraction));
}

void BriefingPage::show_error(const QString& text) {
  progress_->hide();
  state_->setText(text);
  state_->setWordWrap(true);
}

void BriefingPage::show_case(const cases::OpenCase& open, Difficulty difficulty) {
  const cases::Case& the_case = open.the_case;
  const scene::Guidance guidance = guidance_of(difficulty);
  title_->setText(to_qt(the_case.task.title));
  subtitle_->setText(tr("Patient %1 · %2 · %3: %4")
                         .arg(to_qt(the_case.patient->name), to_qt(the_case.needle.title), tr(title_of(difficulty)),
                              tr(help_text_of(difficulty))));
  const QString goal = referral_text(the_case) + goal_text(the_case);
  goal_->setText(difficulty == Difficulty::kExam ? goal : goal + way_text(the_case));
  counts_->setText(counts_text(the_case));
  const QSize side(qMax(240, axial_->width()), qMax(160, axial_->height()));
  // A plane along the path would reveal the path.
  const BriefingPlane second =
      guidance == scene::Guidance::kPath ? BriefingPlane::kAlongPath : BriefingPlane::kSagittal;
  axial_->setPixmap(QPixmap::fromImage(briefing_picture(open, BriefingPlane::kAxial, side, guidance)));
  second_->setPixmap(QPixmap::fromImage(briefing_picture(open, second, side, guidance)));
  progress_->hide();
  state_->setText(tr("Ready"));
  begin_->setEnabled(true);
  begin_->setFocus();
}

void BriefingPage::show_later(const QString& step) {
  state_->setText(step.isEmpty() ? tr("Ready") : tr("Ready. Being prepared: %1").arg(step));
}

}  // namespace trocar::trainer
