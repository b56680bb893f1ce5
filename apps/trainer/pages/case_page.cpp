#include "pages/case_page.h"

#include <QButtonGroup>
#include <QGridLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QMessageBox>
#include <QProgressBar>
#include <QPushButton>
#include <QScrollArea>
#include <QStackedWidget>
#include <QVBoxLayout>

#include "case_builder/case_edits.h"
#include "case_builder/ultrasound.h"
#include "pages/case_views.h"
#include "tasks/assess_path.h"
#include "ui_kit/check_list.h"
#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

constexpr int kPanelWidth = 364;
constexpr int kChecksHeight = 132;
constexpr int kFootHeight = 36;

const char* hint_of(CaseClick click) {
  switch (click) {
    case CaseClick::kLook:
      return "";
    case CaseClick::kTarget:
      return QT_TRANSLATE_NOOP("Table", "Click the target: in a slice, or by a double click in 3D. Esc: done.");
    case CaseClick::kZone:
      return QT_TRANSLATE_NOOP("Table", "Click the centre of the entry zone on the skin. Esc: done.");
    case CaseClick::kEntry:
      return QT_TRANSLATE_NOOP("Table", "Click the entry point; it is moved onto the skin. Esc: done.");
    case CaseClick::kTip:
      return QT_TRANSLATE_NOOP("Table", "Click the end position of the tip. Esc: done.");
    case CaseClick::kLandmark:
      return QT_TRANSLATE_NOOP("Table", "Click the position of “%1”: in a slice, or double-click in 3D. Esc: done.");
    case CaseClick::kPair:
      return QT_TRANSLATE_NOOP("Table", "Click “%1” in a slice of the CT, and in one of the ultrasound. Esc: done.");
  }
  return "";
}

}  // namespace

CasePage::CasePage(QWidget* parent) : QWidget(parent), editor_(std::make_unique<case_builder::CaseEditor>()) {
  setObjectName(QStringLiteral("case-page"));
  setFocusPolicy(Qt::StrongFocus);
  auto* page = new QVBoxLayout(this);
  page->setContentsMargins(16, 8, 16, 8);
  page->setSpacing(8);
  page->addWidget(make_head());
  auto* middle = new QHBoxLayout;
  middle->setSpacing(8);
  middle->addWidget(make_steps());
  auto* right = new QVBoxLayout;
  right->setSpacing(8);
  right->addWidget(make_views(), 1);
  checks_ = new CheckList;
  checks_->setFixedHeight(kChecksHeight);
  right->addWidget(checks_);
  middle->addLayout(right, 1);
  page->addLayout(middle, 1);
  page->addWidget(make_foot());
  connect(checks_, &CheckList::check_chosen, this, [this](const case_builder::CaseCheck& check) {
    go_to(static_cast<int>(check.step));
    if (check.where_P) views_->show_place(*check.where_P);
  });
  go_to(0);
  refresh();
}

CasePage::~CasePage() = default;

QWidget* CasePage::make_head() {
  auto* head = new QWidget;
  auto* row = new QHBoxLayout(head);
  row->setContentsMargins(0, 0, 0, 0);
  row->addWidget(make_label(tr("Case builder"), "heading"));
  click_text_ = make_label({}, "badge");
  click_text_->setObjectName(QStringLiteral("case-click-text"));
  row->addSpacing(16);
  row->addWidget(click_text_);
  row->addStretch();
  undo_ = make_button("case-undo", tr("Undo"), Action::kUndo);
  redo_ = make_button("case-redo", tr("Redo"), Action::kRedo);
  row->addWidget(undo_);
  row->addWidget(redo_);
  connect(undo_, &QPushButton::clicked, this, [this] { editor_->undo(); });
  connect(redo_, &QPushButton::clicked, this, [this] { editor_->redo(); });
  return head;
}

QWidget* CasePage::make_steps() {
  QBoxLayout* content = nullptr;
  QFrame* card = make_card({}, content);
  card->setFixedWidth(kPanelWidth);
  content->setContentsMargins(12, 12, 12, 12);
  content->setSpacing(4);
  auto* buttons = new QGridLayout;
  buttons->setSpacing(4);
  content->addLayout(buttons);
  const QStringList titles{tr("Import"), tr("Labels"),     tr("Target"), tr("Path"),
                           tr("Forces"), tr("Ultrasound"), tr("Save")};
  auto* group = new QButtonGroup(this);
  for (int step = 0; step < case_builder::kCaseSteps; ++step) {
    const QKeySequence key = keys_of(Action::kCaseStep)[static_cast<std::size_t>(step)];
    QPushButton* button =
        make_button(qPrintable(QStringLiteral("case-step-%1").arg(step + 1)),
                    QStringLiteral("%1 %2").arg(step + 1).arg(titles[step]),
                    QStringLiteral("%1  (%2)").arg(tr("Go to this step"), key.toString(QKeySequence::NativeText)));
    button->setShortcut(key);
    button->setCheckable(true);
    button->setStyleSheet(QStringLiteral("padding: 6px 4px; text-align: left;"));
    buttons->addWidget(button, step / 3, step % 3);
    group->addButton(button);
    steps_.push_back(button);
    connect(button, &QPushButton::clicked, this, [this, step] { go_to(step); });
  }
  step_title_ = make_label({}, "heading");
  content->addSpacing(8);
  content->addWidget(step_title_);
  stack_ = new QStackedWidget;
  stack_->setStyleSheet(QStringLiteral("QStackedWidget { background: transparent; }"));
  content->addWidget(stack_, 1);
  add_panel(make_import_panel(*editor_, this), tr("Import CT and labels"));
  add_panel(make_labels_panel(*editor_, this), tr("Check the labels"));
  add_panel(make_target_panel(*editor_, this), tr("Target and risks"));
  add_panel(make_path_panel(*editor_, this), tr("Entry and path"));
  add_panel(make_force_panel(*editor_, this), tr("Forces along the path"));
  add_panel(make_ultrasound_panel(*editor_, this), tr("Recorded ultrasound"));
  add_panel(make_save_panel(*editor_, this), tr("Name and save"));
  return card;
}

void CasePage::add_panel(CasePanel* panel, const QString& title) {
  panel->setProperty("title", title);
  auto* scroll = make_scrolled(*panel);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  stack_->addWidget(scroll);
  panels_.push_back(panel);
  connect(panel, &CasePanel::click_requested, this, &CasePage::set_click);
  connect(panel, &CasePanel::click_name_changed, this, &CasePage::show_hint);
  connect(panel, &CasePanel::place_requested, this, [this](const Vec3& p_P) { views_->show_place(p_P); });
  connect(panel, &CasePanel::ultrasound_place_requested, this,
          [this](const Vec3& p_U) { views_->show_ultrasound_place(p_U); });
  connect(panel, &CasePanel::fusion_changed, this,
          [this](const slices::FusionStyle& style) { views_->set_fusion(style); });
  connect(panel, &CasePanel::label_opacity_changed, this,
          [this](double opacity) { views_->set_label_opacity(opacity); });
  connect(panel, &CasePanel::label_visible_changed, this,
          [this](const QString& name, bool is_visible) { views_->set_label_visible(to_std(name), is_visible); });
  connect(panel, &CasePanel::case_opened, this, &CasePage::case_saved);
}

QWidget* CasePage::make_views() {
  views_ = new CaseViews(*editor_);
  connect(views_, &CaseViews::placed, this, &CasePage::click_at);
  connect(views_, &CaseViews::placed_in_ultrasound, this, &CasePage::click_ultrasound_at);
  return views_;
}

QWidget* CasePage::make_foot() {
  auto* foot = new QWidget;
  auto* row = new QHBoxLayout(foot);
  row->setContentsMargins(0, 0, 0, 0);
  message_ = make_label({}, "");
  message_->setObjectName(QStringLiteral("case-message"));
  message_->setWordWrap(true);
  message_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  row->addWidget(message_, 1);
  progress_ = new QProgressBar;
  progress_->setObjectName(QStringLiteral("case-progress"));
  progress_->setAccessibleName(tr("Progress"));
  progress_->setRange(0, 1000);
  progress_->setFixedWidth(240);
  row->addWidget(progress_);
  cancel_ = make_button("case-cancel", tr("Cancel"), tr("Cancel the running work; the case is unchanged"));
  row->addWidget(cancel_);
  connect(cancel_, &QPushButton::clicked, this, [this] { editor_->cancel(); });
  // A wrapped text would give the page a height that depends on its width, and thus the views' preferred heights
  // instead of those of the window; a scroll area prevents this.
  QScrollArea* area = make_scrolled(*foot);
  area->setFixedHeight(kFootHeight);
  area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  area->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  return area;
}

void CasePage::go_to(int step) {
  steps_[static_cast<std::size_t>(step)]->setChecked(true);
  stack_->setCurrentIndex(step);
  step_title_->setText(panels_[static_cast<std::size_t>(step)]->property("title").toString());
  views_->set_ultrasound_shown(step == static_cast<int>(case_builder::CaseStep::kUltrasound));
  set_click(CaseClick::kLook);
}

void CasePage::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape && click_ != CaseClick::kLook) return set_click(CaseClick::kLook);
  QWidget::keyPressEvent(event);
}

void CasePage::set_click(CaseClick click) {
  click_ = click;
  show_hint();
  click_text_->setVisible(click != CaseClick::kLook);
  for (CasePanel* panel : panels_) panel->show_click(click);
}

void CasePage::show_hint() {
  QString text = tr(hint_of(click_));
  if (click_ == CaseClick::kLandmark || click_ == CaseClick::kPair) text = text.arg(to_qt(click_name()));
  click_text_->setText(text);
}

/// Of the visible panel.
std::string CasePage::click_name() const {
  return panels_[static_cast<std::size_t>(stack_->currentIndex())]->click_name();
}

Result<case_builder::CaseDraft> CasePage::clicked_draft(const Vec3& p_P) const {
  const case_builder::CaseDraft& draft = editor_->draft();
  const anatomy::NeedlePath* path = case_builder::find_expert_path(draft);
  switch (click_) {
    case CaseClick::kTarget:
      return case_builder::set_target_point(draft, p_P);
    case CaseClick::kZone:
      return case_builder::set_entry_zone(draft, p_P, draft.task.entry_zone ? draft.task.entry_zone->radius_mm : 20.0);
    case CaseClick::kEntry: {
      const auto target_P = path != nullptr ? std::optional(path->line_P.b) : case_builder::find_target_point(draft);
      if (!target_P) return fail("a path needs a target first", {}, "go to step 3 and select one");
      const auto entry_P = tasks::find_nearest_skin(*editor_->patient(), p_P);
      if (!entry_P) return fail("no skin near this position", {}, "click on the patient's skin");
      Segment line_P{*entry_P, *target_P};
      // A biopsy needle stops short of the target, so that the notch is in the target.
      if (const tasks::Needle* needle = editor_->needle(); path == nullptr && needle != nullptr)
        line_P.b -= needle->notch_middle_mm() * line_P.direction();
      return case_builder::set_expert_path(draft, line_P);
    }
    case CaseClick::kTip:
      if (path == nullptr)
        return fail("the path has no entry point yet", {}, "set the entry, or let the program plan it");
      return case_builder::set_expert_path(draft, {path->line_P.a, p_P});
    case CaseClick::kLandmark:
    case CaseClick::kPair:
      return case_builder::set_landmark(draft, click_name(), p_P);
    case CaseClick::kLook:
      break;
  }
  return draft;
}

void CasePage::click_at(const Vec3& p_P, bool is_drag) {
  if (click_ == CaseClick::kLook || !editor_->patient()) return;
  const char* const words[] = {"",
                               "set the target",
                               "set the entry zone",
                               "set the entry",
                               "set the tip",
                               "place a landmark",
                               "place a landmark"};
  const std::string what = words[static_cast<std::size_t>(click_)];
  // Press and drag are one step; the release ends it.
  editor_->edit(clicked_draft(p_P), what, what + std::to_string(clicks_));
  if (!is_drag) ++clicks_;
}

void CasePage::click_ultrasound_at(const Vec3& p_U, bool is_drag) {
  if (click_ != CaseClick::kPair) return;
  const std::string what = "place a landmark in the ultrasound";
  editor_->edit(case_builder::set_ultrasound_landmark(editor_->draft(), click_name(), p_U), what,
                what + std::to_string(clicks_));
  if (!is_drag) ++clicks_;
}

void CasePage::refresh_foot() {
  const bool is_busy = editor_->work() != case_builder::CaseEditor::Work::kNone;
  const JobView view = editor_->work_view();
  progress_->setVisible(is_busy);
  progress_->setValue(static_cast<int>(1000.0 * view.fraction));
  cancel_->setVisible(is_busy && editor_->work() != case_builder::CaseEditor::Work::kSaving);
  const QString text = is_busy ? shown(view.step) : shown(editor_->message());
  message_->setText(text);
  message_->setToolTip(text);
  message_->setStyleSheet(!is_busy && editor_->is_error() ? QStringLiteral("color: %1;").arg(theme().bad.name())
                                                          : QString());
}

void CasePage::refresh() {
  refresh_foot();
  // A change of progress only updates the bar.
  const Shown now{editor_->history().version(), editor_->is_reviewed(), editor_->work(), editor_->patient().get(),
                  editor_->message()};
  if (now == shown_) return;
  shown_ = now;
  for (CasePanel* panel : panels_) panel->refresh();
  for (int step = 0; step < case_builder::kCaseSteps; ++step) {
    std::optional<case_builder::CheckLevel> level;
    if (editor_->has_patient() && editor_->is_reviewed())
      level = case_builder::worst_level(editor_->checks(), static_cast<case_builder::CaseStep>(step));
    steps_[static_cast<std::size_t>(step)]->setIcon(level_icon(level));
  }
  checks_->show_checks(editor_->checks());
  const case_builder::CaseHistory& history = editor_->history();
  undo_->setEnabled(history.can_undo());
  redo_->setEnabled(history.can_redo());
  undo_->setToolTip(tr("Undo: %1  (Ctrl+Z)").arg(shown(history.undo_text())));
  redo_->setToolTip(tr("Redo: %1  (Ctrl+Shift+Z)").arg(shown(history.redo_text())));
  views_->refresh(click_ == CaseClick::kLook);
}

void CasePage::advance() {
  if (editor_->advance()) refresh();
  if (isVisible()) views_->draw();
}

bool CasePage::may_discard(const QString& question) {
  const bool is_importing = editor_->work() == case_builder::CaseEditor::Work::kImporting;
  if (!is_importing && (!editor_->has_patient() || editor_->is_saved())) return true;
  QMessageBox box(QMessageBox::Question, tr("Unsaved case"), question, QMessageBox::NoButton, window());
  box.setObjectName(QStringLiteral("case-discard"));
  auto* discard = box.addButton(tr("Discard the case"), QMessageBox::DestructiveRole);
  discard->setObjectName(QStringLiteral("case-discard-yes"));
  auto* keep = box.addButton(tr("Go back to the case"), QMessageBox::RejectRole);
  keep->setObjectName(QStringLiteral("case-discard-no"));
  box.setDefaultButton(keep);
  box.exec();
  return box.clickedButton() == discard;
}

}  // namespace trocar::trainer
