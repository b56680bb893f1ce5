#include "pages/briefing_page.h"

#include <QEvent>
#include <QImage>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QScrollArea>
#include <QVBoxLayout>
#include <algorithm>

#include "pages/briefing_text.h"
#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "ui_kit/window_language.h"
#include "views/slices/briefing_picture.h"

namespace trocar::trainer {
namespace {

constexpr int kProgressSteps = 1000;
constexpr int kTextCardGap_px = 12;
constexpr int kWide_px = 1300;  ///< From here on, there is room for a second column of text.

QLabel* paragraph(const char* name) {
  auto* label = make_label({});
  label->setObjectName(QString::fromLatin1(name));
  label->setTextFormat(Qt::RichText);
  label->setWordWrap(true);
  label->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  return label;
}

QFrame* text_card(const QString& heading, QLabel* text) {
  QBoxLayout* content = nullptr;
  QFrame* card = make_card(heading, content);
  content->addWidget(text);
  content->addStretch();
  return card;
}

QString legend_part_html(const QColor& color, const QString& symbol, const QString& words) {
  return QStringLiteral("<span style='color:%1'>%2</span>&nbsp;%3")
      .arg(color.name(), symbol, words.toHtmlEscaped().replace(QLatin1Char(' '), QStringLiteral("&nbsp;")));
}

/// The marks of the plan, then the colours of both slices, the largest area first.
QString legend_html(const std::vector<LegendEntry>& entries, scene::Guidance guidance) {
  const Theme& t = theme();
  QStringList parts{guidance == scene::Guidance::kPath
                        ? legend_part_html(t.target, QStringLiteral("◯"), BriefingPage::tr("end of the path"))
                        : legend_part_html(t.target, QStringLiteral("◯"), BriefingPage::tr("target"))};
  if (guidance != scene::Guidance::kNone)
    parts << legend_part_html(t.path, QStringLiteral("◯"), BriefingPage::tr("entry"));
  if (guidance == scene::Guidance::kPath)
    parts << legend_part_html(t.path, QStringLiteral("- -"), BriefingPage::tr("planned path"));
  for (const LegendEntry& entry : entries) parts << legend_part_html(entry.color, QStringLiteral("■"), entry.words);
  return parts.join(QStringLiteral("&nbsp;&nbsp; "));  // a new line begins with an entry
}

/// Entries of two slices; the same colour once, targets first.
std::vector<LegendEntry> joined_legends(std::vector<LegendEntry> a, const std::vector<LegendEntry>& b) {
  for (const LegendEntry& entry : b) {
    const auto same = std::find_if(a.begin(), a.end(), [&](const LegendEntry& e) { return e.color == entry.color; });
    if (same == a.end()) {
      a.push_back(entry);
    } else {
      same->share += entry.share;
      if (entry.largest_share > same->largest_share) {
        same->largest = entry.largest;
        same->largest_share = entry.largest_share;
      }
    }
  }
  std::stable_sort(a.begin(), a.end(), [](const LegendEntry& x, const LegendEntry& y) {
    return x.is_target != y.is_target ? x.is_target : x.share > y.share;
  });
  return a;
}

/// "Exam: Images and forces only. Exam 4711: an unseen body."
QString level_line(const TrainerChoice& choice) {
  const QString level = BriefingPage::tr(title_of(choice.mode));
  return QStringLiteral("%1: %2 %3")
      .arg(level, BriefingPage::tr(help_text_of(choice.mode)), exam_text(choice))
      .trimmed();
}

}  // namespace

BriefingPage::BriefingPage(QWidget* parent)
    : QWidget(parent), keys_(*this, [this](const QKeyEvent& key, const KeyPlace& place) {
        return press_by_enter(key, place, Action::kBegin, *begin_);
      }) {
  setObjectName(QStringLiteral("briefing-page"));
  auto* page = new QVBoxLayout(this);
  page->setContentsMargins(24, 16, 24, 16);
  page->setSpacing(10);
  title_ = make_label({}, "title");
  subtitle_ = make_label({}, "dim");
  subtitle_->setWordWrap(true);
  page->addWidget(title_);
  page->addWidget(subtitle_);
  auto* columns = new QHBoxLayout;
  columns->setSpacing(12);
  columns->addWidget(make_texts(), 6);
  columns->addWidget(make_pictures(), 5);
  page->addLayout(columns, 1);
  page->addWidget(make_bottom());
}

QWidget* BriefingPage::make_texts() {
  auto* content = new QWidget;
  cards_ = new QHBoxLayout(content);
  cards_->setContentsMargins(0, 0, 0, 0);
  for (QVBoxLayout** column : {&left_, &right_}) {
    *column = new QVBoxLayout;
    (*column)->setSpacing(kTextCardGap_px);
    (*column)->addStretch();
    cards_->addLayout(*column, 6);
  }
  referral_ = paragraph("briefing-referral");
  procedure_ = paragraph("briefing-procedure");
  scoring_ = paragraph("briefing-scoring");
  controls_ = paragraph("briefing-controls");
  card_widgets_ = {text_card(tr("Referral"), referral_), text_card(tr("Procedure"), procedure_),
                   text_card(tr("Scoring"), scoring_), text_card(tr("Controls"), controls_)};
  place_cards();
  text_area_ = make_scrolled(*content);
  text_area_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  text_area_->setMinimumSize(380, 200);
  text_area_->setFocusPolicy(Qt::StrongFocus);  // arrow keys scroll
  return text_area_;
}

QWidget* BriefingPage::make_pictures() {
  QBoxLayout* content = nullptr;
  QFrame* card = make_card(tr("Target location"), content);
  auto* pictures = new QVBoxLayout;
  for (QLabel** label : {&axial_, &second_}) {
    *label = make_label({}, "dim");
    (*label)->setAlignment(Qt::AlignCenter);
    (*label)->setWordWrap(true);
    (*label)->setMinimumSize(240, 120);
    (*label)->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Ignored);
    (*label)->installEventFilter(this);
    pictures->addWidget(*label, 1);
  }
  content->addLayout(pictures, 1);
  legend_ = paragraph("briefing-legend");
  content->addWidget(legend_);
  return card;
}

QWidget* BriefingPage::make_bottom() {
  auto* bottom = new QWidget;
  auto* row = new QHBoxLayout(bottom);
  row->setContentsMargins(0, 0, 0, 0);
  auto* back = make_button("back", tr("Back"), Action::kBack);
  row->addWidget(back);
  state_ = make_label({}, "dim");
  state_->setObjectName(QStringLiteral("opening-state"));
  row->addWidget(state_, 1);
  progress_ = new QProgressBar;
  progress_->setObjectName(QStringLiteral("opening-progress"));
  progress_->setRange(0, kProgressSteps);
  progress_->setFixedWidth(260);
  row->addWidget(progress_);
  begin_ = make_button("begin", tr("Begin"), Action::kBegin);
  begin_->setProperty("role", "primary");
  row->addWidget(begin_);
  connect(back, &QPushButton::clicked, this, &BriefingPage::back_requested);
  connect(begin_, &QPushButton::clicked, this, &BriefingPage::begin_requested);
  return bottom;
}

void BriefingPage::place_cards() {
  const bool is_wide = width() >= kWide_px;
  for (QWidget* card : card_widgets_) {
    left_->removeWidget(card);
    right_->removeWidget(card);
  }
  for (std::size_t n = 0; n < card_widgets_.size(); ++n) {
    QBoxLayout* column = is_wide && n >= 2 ? right_ : left_;
    column->insertWidget(column->count() - 1, card_widgets_[n]);  // before the stretch
  }
  cards_->setStretch(1, is_wide ? 5 : 0);
  cards_->setSpacing(is_wide ? kTextCardGap_px : 0);
}

void BriefingPage::show_tables(const cases::Case& tables, std::optional<bool> is_parenchymal) {
  title_->setText(shown(tables.task.title));
  procedure_->setText(form_html(procedure_rows(tables, is_parenchymal)));
  scoring_->setText(form_html(scoring_rows(tables)));
}

void BriefingPage::show_opening(const TrainerChoice& choice) {
  choice_ = choice;
  open_.reset();
  title_->setText(tr("Briefing"));
  subtitle_->setText(level_line(choice_));
  procedure_->clear();
  scoring_->clear();
  // An error of the tables is reported by the opening, which reads them, too.
  const auto tables = load_briefing_tables(choice);
  if (tables) show_tables(*tables);
  std::vector<BriefingRow> rows = referral_rows(choice);
  if (tables && is_lesion_task(tables->task)) rows.push_back({tr("Finding"), tr("follows when the images are loaded")});
  referral_->setText(form_html(rows));
  controls_->setText(form_html(control_rows(choice, tables ? &*tables : nullptr)));
  axial_->setText(tr("The images are being loaded."));
  second_->clear();
  legend_->clear();
  hinder_begin();
  progress_->show();
  show_progress(tr("Opening the patient"), 0.0);
}

void BriefingPage::show_progress(const QString& step, double fraction) {
  state_->setText(step);
  progress_->setValue(static_cast<int>(kProgressSteps * fraction));
}

void BriefingPage::show_error(const QString& text) {
  progress_->hide();
  axial_->clear();
  state_->setText(text);
  state_->setWordWrap(true);
}

void BriefingPage::show_case(std::shared_ptr<const cases::OpenCase> open, TrainingMode mode) {
  open_ = std::move(open);
  choice_.patient = open_->choice.patient_source;
  choice_.mode = mode;
  const cases::Case& the_case = open_->the_case;
  show_tables(the_case, the_case.is_parenchymal);
  subtitle_->setText(level_line(choice_));
  std::vector<BriefingRow> rows = referral_rows(choice_);
  for (BriefingRow& row : finding_rows(the_case)) rows.push_back(std::move(row));
  if (mode != TrainingMode::kExam) rows.push_back(path_row(the_case));
  referral_->setText(form_html(rows));
  show_legend();
  for (QLabel* label : {axial_, second_}) show_picture(*label);
  progress_->hide();
  state_->setText(tr("Ready"));
  set_hindrance({});
  begin_->setFocus();
}

void BriefingPage::set_hindrance(const QString& reason) {
  if (reason.isEmpty() && is_hindered()) state_->setText(tr("Ready"));
  hindrance_ = reason;
  begin_->setToolTip(reason.isEmpty() ? tooltip_of(Action::kBegin) : reason);
  if (reason.isEmpty()) {
    begin_->setEnabled(open_ != nullptr);
    return;
  }
  state_->setText(reason);
  hinder_begin();
}

void BriefingPage::hinder_begin() {
  // Qt hands the focus of a disabled button to any other one, which the next Enter would press.
  if (begin_->window()->focusWidget() == begin_) text_area_->setFocus();
  begin_->setEnabled(false);
}

BriefingPlane BriefingPage::plane_of(const QLabel& label) const {
  if (&label == axial_) return BriefingPlane::kAxial;
  // A plane along the path would reveal the path.
  return guidance_of(choice_.mode) == scene::Guidance::kPath ? BriefingPlane::kAlongPath : BriefingPlane::kSagittal;
}

void BriefingPage::show_picture(QLabel& label) {
  if (!open_ || label.width() < 16 || label.height() < 16) return;
  const scene::Guidance guidance = guidance_of(choice_.mode);
  label.setPixmap(QPixmap::fromImage(briefing_picture(*open_, plane_of(label), label.size(), guidance)));
}

void BriefingPage::show_legend() {
  const scene::Guidance guidance = guidance_of(choice_.mode);
  std::vector<LegendEntry> entries;
  for (const QLabel* label : {axial_, second_}) {
    const QSize size = label->size().expandedTo({240, 120});
    entries = joined_legends(std::move(entries), briefing_legend(*open_, plane_of(*label), size, guidance));
  }
  tell_apart(entries);
  legend_->setText(legend_html(entries, guidance));
}

void BriefingPage::show_later(const QString& step) {
  if (is_hindered()) return;
  state_->setText(step.isEmpty() ? tr("Ready") : tr("Ready. Being prepared: %1").arg(step));
}

void BriefingPage::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  place_cards();
}

/// The slices are drawn in the size that the layout leaves for them.
bool BriefingPage::eventFilter(QObject* object, QEvent* event) {
  if (event->type() == QEvent::Resize)
    for (QLabel* label : {axial_, second_})
      if (object == label) show_picture(*label);
  return QWidget::eventFilter(object, event);
}

}  // namespace trocar::trainer
