#include "case_panels/case_landmark_pairs.h"

#include <QComboBox>
#include <QHeaderView>
#include <QKeyEvent>
#include <QLabel>
#include <QPushButton>
#include <QTableWidget>
#include <QVBoxLayout>
#include <algorithm>

#include "case_builder/case_edits.h"
#include "case_builder/ultrasound.h"
#include "case_panels/landmark_text.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

enum PairColumn { kPairName, kPairInCt, kPairInUltrasound, kPairResidual, kPairColumns };
constexpr int kListHeight = 150;

const anatomy::Landmark* find_in_ct(const case_builder::CaseDraft& draft, const std::string& name) {
  for (const anatomy::Landmark& landmark : draft.landmarks)
    if (landmark.name == name) return &landmark;
  return nullptr;
}

const registration::NamedPoint* find_in_ultrasound(const case_builder::CaseDraft& draft, const std::string& name) {
  for (const registration::NamedPoint& point : draft.ultrasound_landmarks)
    if (point.name == name) return &point;
  return nullptr;
}

/// Of both volumes; those of the ultrasound first.
std::vector<std::string> all_names(const case_builder::CaseDraft& draft) {
  std::vector<std::string> names;
  for (const registration::NamedPoint& point : draft.ultrasound_landmarks) names.push_back(point.name);
  for (const anatomy::Landmark& landmark : draft.landmarks)
    if (find_in_ultrasound(draft, landmark.name) == nullptr) names.push_back(landmark.name);
  return names;
}

}  // namespace

CaseLandmarkPairs::CaseLandmarkPairs(case_builder::CaseEditor& editor, QWidget* parent)
    : QWidget(parent), editor_(editor) {
  auto* content = new QVBoxLayout(this);
  content->setContentsMargins(0, 0, 0, 0);
  content->setSpacing(8);
  add_naming();
  add_list();
  add_buttons();
}

void CaseLandmarkPairs::add_naming() {
  auto* row = new QHBoxLayout;
  name_ = new QComboBox;
  name_->setObjectName(QStringLiteral("case-pair-name"));
  name_->setAccessibleName(tr("Name of the landmark pair"));
  name_->setToolTip(tr("A landmark of the case, or any other name: a branching of a vessel, the pole of a kidney"));
  name_->setEditable(true);
  name_->setInsertPolicy(QComboBox::NoInsert);
  name_->setMinimumContentsLength(8);
  name_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  name_->setEditText(shown("landmark 1"));
  connect(name_, &QComboBox::editTextChanged, this, &CaseLandmarkPairs::name_changed);
  pick_ = make_button("case-pair-pick", tr("Place by click"), Action::kPickPair,
                      tr("Click the same place in a slice of the CT and in one of the ultrasound, in any order"));
  pick_->setCheckable(true);
  connect(pick_, &QPushButton::clicked, this, &CaseLandmarkPairs::picking_requested);
  QPushButton* next = make_button("case-pair-new", tr("New"), tr("Begin another landmark: the next free number"));
  connect(next, &QPushButton::clicked, this, &CaseLandmarkPairs::begin_next);
  row->addWidget(name_, 1);
  row->addWidget(next);
  qobject_cast<QVBoxLayout*>(layout())->addLayout(row);
  layout()->addWidget(pick_);
}

void CaseLandmarkPairs::add_list() {
  list_ = new QTableWidget(0, kPairColumns);
  list_->setObjectName(QStringLiteral("case-pairs"));
  list_->setAccessibleName(tr("Landmark pairs"));
  list_->setToolTip(tr("Click to go there  (Enter); Delete removes the landmark of the ultrasound"));
  list_->setHorizontalHeaderLabels({tr("Landmark"), tr("CT"), tr("US"), tr("Off")});
  list_->horizontalHeaderItem(kPairResidual)->setToolTip(tr("Distance between both points after the fit"));
  list_->verticalHeader()->hide();
  list_->verticalHeader()->setDefaultSectionSize(24);
  list_->horizontalHeader()->setSectionResizeMode(kPairName, QHeaderView::Stretch);
  list_->setColumnWidth(kPairInCt, 32);
  list_->setColumnWidth(kPairInUltrasound, 32);
  list_->setColumnWidth(kPairResidual, 64);
  list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  list_->horizontalHeader()->setMinimumSectionSize(24);
  list_->setShowGrid(false);
  list_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  list_->setSelectionBehavior(QAbstractItemView::SelectRows);
  list_->setSelectionMode(QAbstractItemView::SingleSelection);
  list_->setFixedHeight(kListHeight);
  list_->installEventFilter(this);
  connect(list_, &QTableWidget::cellClicked, this, [this](int row, int) { show_row(row); });
  connect(list_, &QTableWidget::cellActivated, this, [this](int row, int) { show_row(row); });
  layout()->addWidget(list_);
}

void CaseLandmarkPairs::add_buttons() {
  auto* row = new QHBoxLayout;
  fit_ = make_button("case-pair-fit", tr("Fit landmarks"), tr("Place the ultrasound by its landmark pairs: 3 or more"));
  remove_ = make_button("case-pair-remove", tr("Remove"), tr("Remove the landmark from the ultrasound  (Delete)"));
  row->addWidget(fit_);
  row->addWidget(remove_);
  connect(fit_, &QPushButton::clicked, this,
          [this] { editor_.edit(case_builder::place_by_landmarks(editor_.draft()), "fit the landmarks"); });
  connect(remove_, &QPushButton::clicked, this, &CaseLandmarkPairs::remove_current);
  qobject_cast<QVBoxLayout*>(layout())->addLayout(row);
  result_ = make_label({}, "dim");
  result_->setObjectName(QStringLiteral("case-pair-result"));
  result_->setWordWrap(true);
  layout()->addWidget(result_);
}

std::string CaseLandmarkPairs::name() const {
  return landmark_of(name_->currentText());
}

void CaseLandmarkPairs::begin_next() {
  const std::vector<std::string> taken = all_names(editor_.draft());
  for (int n = 1;; ++n) {
    const std::string name = "landmark " + std::to_string(n);
    if (std::find(taken.begin(), taken.end(), name) != taken.end()) continue;
    return name_->setEditText(landmark_text(name));
  }
}

void CaseLandmarkPairs::show_picking(bool is_on) {
  pick_->setChecked(is_on);
}

void CaseLandmarkPairs::show_row(int row) {
  if (list_->item(row, kPairName) == nullptr) return;
  const std::string name = landmark_of(list_->item(row, kPairName)->text());
  name_->setEditText(landmark_text(name));
  const case_builder::CaseDraft& draft = editor_.draft();
  if (const auto* point = find_in_ultrasound(draft, name)) Q_EMIT ultrasound_place_requested(point->p);
  // Last, since with a pose it also moves the ultrasound: the CT's landmark is the one that may be misplaced there.
  if (const auto* landmark = find_in_ct(draft, name)) Q_EMIT place_requested(landmark->p_P);
}

void CaseLandmarkPairs::remove_current() {
  const int row = list_->currentRow();
  if (row < 0) return;
  const std::string name = landmark_of(list_->item(row, kPairName)->text());
  editor_.edit(case_builder::remove_ultrasound_landmark(editor_.draft(), name), "remove a landmark of the ultrasound");
}

bool CaseLandmarkPairs::eventFilter(QObject* watched, QEvent* event) {
  if (watched == list_ && event->type() == QEvent::KeyPress &&
      static_cast<QKeyEvent*>(event)->key() == Qt::Key_Delete) {
    remove_current();
    return true;
  }
  return QWidget::eventFilter(watched, event);
}

/// Names that the user has not typed: those of the case, then the common ones.
void CaseLandmarkPairs::fill_names() {
  QStringList names;
  for (const std::string& name : all_names(editor_.draft())) names << landmark_text(name);
  for (const std::string_view name : case_builder::landmark_names())
    if (!names.contains(shown(name))) names << shown(name);
  QStringList listed;
  for (int n = 0; n < name_->count(); ++n) listed << name_->itemText(n);
  if (listed == names) return;
  const QString typed = name_->currentText();
  const QSignalBlocker blocker(name_);
  name_->clear();
  name_->addItems(names);
  name_->setEditText(typed);
}

void CaseLandmarkPairs::fill_list() {
  const case_builder::CaseDraft& draft = editor_.draft();
  const std::vector<std::string> names = all_names(draft);
  const auto fit = case_builder::fit_of_landmarks(draft);
  const int current = list_->currentRow();
  list_->setRowCount(static_cast<int>(names.size()));
  for (int row = 0; row < list_->rowCount(); ++row) {
    const std::string& name = names[static_cast<std::size_t>(row)];
    const auto put = [&](PairColumn column, const QString& text) {
      if (list_->item(row, column) == nullptr) list_->setItem(row, column, new QTableWidgetItem);
      list_->item(row, column)->setText(text);
      list_->item(row, column)->setToolTip(text);
    };
    put(kPairName, landmark_text(name));
    put(kPairInCt, find_in_ct(draft, name) != nullptr ? QStringLiteral("✓") : QStringLiteral("–"));
    put(kPairInUltrasound, find_in_ultrasound(draft, name) != nullptr ? QStringLiteral("✓") : QStringLiteral("–"));
    QString off;
    if (fit)
      for (std::size_t n = 0; n < fit->names.size(); ++n)
        if (fit->names[n] == name) off = tr("%1 mm").arg(fit->fit.residual_mm[n], 0, 'f', 1);
    put(kPairResidual, off);
  }
  if (current >= 0) list_->setCurrentCell(std::min(current, list_->rowCount() - 1), kPairName);
  const auto pairs = std::count_if(names.begin(), names.end(), [&](const std::string& name) {
    return find_in_ct(draft, name) != nullptr && find_in_ultrasound(draft, name) != nullptr;
  });
  fit_->setEnabled(pairs >= 3);
  remove_->setEnabled(!draft.ultrasound_landmarks.empty());
  if (fit)
    result_->setText(tr("%1 pairs fit within %2 mm (rms).").arg(pairs).arg(fit->fit.rms_mm, 0, 'f', 1));
  else
    result_->setText(pairs < 3 ? tr("%1 of at least 3 pairs.").arg(pairs) : shown(fit.error().text()));
}

void CaseLandmarkPairs::refresh() {
  pick_->setEnabled(editor_.draft().ultrasound != nullptr);
  fill_names();
  fill_list();
}

}  // namespace trocar::trainer
