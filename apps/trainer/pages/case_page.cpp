#include "pages/case_page.h"

#include <QApplication>
#include <QButtonGroup>
#include <QGridLayout>
#include <QInputDialog>
#include <QKeyEvent>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QScrollArea>
#include <QStackedWidget>
#include <QVBoxLayout>

#include "case_builder/case_edits.h"
#include "tasks/assess_path.h"
#include "ui_kit/check_list.h"
#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "views/patient/patient_view.h"
#include "views/slices/slice_marks.h"
#include "views/slices/slice_view.h"

namespace trocar::trainer {
namespace {

constexpr int kPanelWidth = 312;
constexpr int kChecksHeight = 132;

const char* hint_of(CaseClick click) {
  switch (click) {
    case CaseClick::kLook:
      return "";
    case CaseClick::kTarget:
      return "Click the target: in a slice, or by a double click in 3D. Esc: done.";
    case CaseClick::kZone:
      return "Click the centre of the entry zone on the skin. Esc: done.";
    case CaseClick::kEntry:
      return "Click the entry point; it is moved onto the skin. Esc: done.";
    case CaseClick::kTip:
      return "Click the end position of the tip. Esc: done.";
    case CaseClick::kLandmark:
      return "Click the position of “%1”: in a slice, or double-click in 3D. Esc: done.";
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
    if (check.where_P) show_place(*check.where_P);
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
  undo_ = make_button("case-undo", tr("Undo"), tr("Undo the last step"), QStringLiteral("Ctrl+Z"));
  redo_ = make_button("case-redo", tr("Redo"), tr("Redo the step"), QStringLiteral("Ctrl+Shift+Z"));
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
  const QStringList titles{tr("Import"), tr("Labels"), tr("Target"), tr("Path"), tr("Forces"), tr("Save")};
  auto* group = new QButtonGroup(this);
  for (int step = 0; step < case_builder::kCaseSteps; ++step) {
    QPushButton* button = make_button(qPrintable(QStringLiteral("case-step-%1").arg(step + 1)),
                                      QStringLiteral("%1 %2").arg(step + 1).arg(titles[step]), tr("Go to this step"),
                                      QStringLiteral("Alt+%1").arg(step + 1));
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
  connect(panel, &CasePanel::place_requested, this, &CasePage::show_place);
  connect(panel, &CasePanel::label_opacity_changed, this, [this](double opacity) {
    for (SliceView* slice : slices_) slice->set_label_opacity(opacity);
  });
  connect(panel, &CasePanel::label_visible_changed, this,
          [this](const QString& name, bool is_visible) { view_->set_opacity(to_std(name), is_visible ? 1.0 : 0.0); });
  connect(panel, &CasePanel::case_opened, this, &CasePage::case_saved);
}

QWidget* CasePage::make_views() {
  auto* views = new QWidget;
  auto* grid = new QGridLayout(views);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setSpacing(4);
  const SliceKind kinds[] = {SliceKind::kAxial, SliceKind::kCoronal, SliceKind::kSagittal};
  for (std::size_t n = 0; n < slices_.size(); ++n) {
    auto* slice = new SliceView(kinds[n]);
    slices_[n] = slice;
    marks_[n] = new SliceMarks(slice);
    connect(slice, &SliceView::focus_moved, this, [this, n](const Vec3& p_P) {
      for (std::size_t other = 0; other < slices_.size(); ++other)
        if (other != n) slices_[other]->set_focus(p_P);
      // The wheel scrolls through slices without a change; a drag changes the draft.
      if (QApplication::mouseButtons().testFlag(Qt::LeftButton)) click_at(p_P, true);
    });
    connect(slice, &SliceView::clicked, this, [this](const Vec3& p_P) { click_at(p_P, false); });
  }
  view_ = new PatientView;
  view_->setObjectName(QStringLiteral("case-3d"));
  view_->set_landmarks_visible(true);
  connect(view_, &PatientView::picked, this, [this](const Vec3& p_P) {
    show_place(p_P);
    click_at(p_P, false);
  });
  grid->addWidget(slices_[0], 0, 0);
  grid->addWidget(view_, 0, 1);
  grid->addWidget(slices_[1], 1, 0);
  grid->addWidget(slices_[2], 1, 1);
  for (int n = 0; n < 2; ++n) {
    grid->setRowStretch(n, 1);
    grid->setColumnStretch(n, 1);
  }
  return views;
}

QWidget* CasePage::make_foot() {
  auto* foot = new QWidget;
  foot->setFixedHeight(36);
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
  return foot;
}

void CasePage::go_to(int step) {
  steps_[static_cast<std::size_t>(step)]->setChecked(true);
  stack_->setCurrentIndex(step);
  step_title_->setText(panels_[static_cast<std::size_t>(step)]->property("title").toString());
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
  if (click_ == CaseClick::kLandmark) text = text.arg(to_qt(click_name()));
  click_text_->setText(text);
}

/// Of the visible panel.
std::string CasePage::click_name() const {
  return panels_[static_cast<std::size_t>(stack_->currentIndex())]->click_name();
}

void CasePage::show_place(const Vec3& p_P) {
  for (SliceView* slice : slices_) slice->set_focus(p_P);
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
      return case_builder::set_landmark(draft, click_name(), p_P);
    case CaseClick::kLook:
      break;
  }
  return draft;
}

void CasePage::click_at(const Vec3& p_P, bool is_drag) {
  if (click_ == CaseClick::kLook || !editor_->patient()) return;
  const char* const words[] = {
      "", "set the target", "set the entry zone", "set the entry", "set the tip", "place a landmark"};
  const std::string what = words[static_cast<std::size_t>(click_)];
  // Press and drag are one step; the release ends it.
  editor_->edit(clicked_draft(p_P), what, what + std::to_string(clicks_));
  if (!is_drag) ++clicks_;
}

void CasePage::refresh_views() {
  if (editor_->patient() != shown_patient_ || editor_->meshes() != shown_meshes_) {
    shown_patient_ = editor_->patient();
    shown_meshes_ = editor_->meshes();
    for (SliceView* slice : slices_) slice->show_patient(shown_patient_);
    const bool is_known = placed_import_ == editor_->draft().imported && view_->is_ready();
    const scene::CameraView before = view_->view();
    if (shown_patient_ && shown_meshes_) view_->show_patient(shown_patient_, shown_meshes_);
    if (is_known) view_->set_view(before);  // a new name or tissue does not change the camera
    shown_landmarks_.reset();
  }
  const case_builder::CaseDraft& draft = editor_->draft();
  const auto target_P = case_builder::find_target_point(draft);
  if (placed_import_ != draft.imported && shown_patient_) {
    placed_import_ = draft.imported;
    for (SliceView* slice : slices_) slice->reset();
    if (target_P) show_place(*target_P);
  }
  const anatomy::NeedlePath* path = case_builder::find_expert_path(draft);
  const std::optional<Segment> line_P = path != nullptr ? std::optional(path->line_P) : std::nullopt;
  if (line_P && !shown_path_ && click_ == CaseClick::kLook) show_place(line_P->b);
  shown_path_ = line_P;
  const std::optional<tasks::EntryZone>& zone = draft.task.entry_zone;
  view_->set_path(line_P, zone ? zone->radius_mm : 0.0);
  view_->scene().set_entry_centre(zone ? std::optional(zone->centre_P) : std::nullopt);
  show_landmarks();
  for (std::size_t n = 0; n < slices_.size(); ++n) {
    slices_[n]->set_path(line_P);
    slices_[n]->set_entry_zone(draft.task.entry_zone);
    marks_[n]->set_target(target_P);
  }
}

void CasePage::show_landmarks() {
  const std::vector<anatomy::Landmark>& landmarks = editor_->draft().landmarks;
  const auto is_same = [](const anatomy::Landmark& a, const anatomy::Landmark& b) {
    return a.name == b.name && a.p_P == b.p_P;
  };
  if (shown_landmarks_ &&
      std::equal(landmarks.begin(), landmarks.end(), shown_landmarks_->begin(), shown_landmarks_->end(), is_same))
    return;
  shown_landmarks_ = landmarks;
  view_->scene().set_landmarks(landmarks);
  for (SliceMarks* marks : marks_) marks->set_landmarks(landmarks);
}

void CasePage::refresh_foot() {
  const bool is_busy = editor_->work() != case_builder::CaseEditor::Work::kNone;
  const JobView view = editor_->work_view();
  progress_->setVisible(is_busy);
  progress_->setValue(static_cast<int>(1000.0 * view.fraction));
  cancel_->setVisible(is_busy && editor_->work() != case_builder::CaseEditor::Work::kSaving);
  const QString text = is_busy ? to_qt(view.step) : to_qt(editor_->message());
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
  undo_->setToolTip(tr("Undo: %1  (Ctrl+Z)").arg(to_qt(history.undo_text())));
  redo_->setToolTip(tr("Redo: %1  (Ctrl+Shift+Z)").arg(to_qt(history.redo_text())));
  refresh_views();
}

void CasePage::advance() {
  if (editor_->advance()) refresh();
  if (isVisible()) view_->draw();
}

}  // namespace trocar::trainer
