#include "case_panels/case_landmarks.h"

#include <QComboBox>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QVBoxLayout>

#include "case_builder/case_edits.h"
#include "case_panels/landmark_text.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {

CaseLandmarks::CaseLandmarks(case_builder::CaseEditor& editor, QWidget* parent) : QWidget(parent), editor_(editor) {
  auto* content = new QVBoxLayout(this);
  content->setContentsMargins(0, 8, 0, 0);
  content->setSpacing(8);
  add_naming();
  add_list();
  add_buttons();
}

void CaseLandmarks::add_naming() {
  layout()->addWidget(make_label(tr("Name: select one, or type a name"), "dim"));
  name_ = new QComboBox;
  name_->setObjectName(QStringLiteral("case-landmark-name"));
  name_->setAccessibleName(tr("Name of the landmark"));
  name_->setToolTip(tr("One of the list, or any other name"));
  name_->setEditable(true);
  name_->setInsertPolicy(QComboBox::NoInsert);
  name_->setMinimumContentsLength(8);
  name_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  for (const std::string_view name : case_builder::landmark_names()) name_->addItem(shown(name));
  connect(name_, &QComboBox::editTextChanged, this, &CaseLandmarks::name_changed);
  layout()->addWidget(name_);
  pick_ = make_button("case-landmark-pick", tr("Place by click"), Action::kPickLandmark,
                      tr("Click in a slice, or double-click in 3D; click again to move it"));
  pick_->setCheckable(true);
  connect(pick_, &QPushButton::clicked, this, &CaseLandmarks::picking_requested);
  layout()->addWidget(pick_);
}

void CaseLandmarks::add_list() {
  list_ = new QListWidget;
  list_->setObjectName(QStringLiteral("case-landmarks"));
  list_->setAccessibleName(tr("Landmarks"));
  list_->setToolTip(tr("Click to go there  (Enter); F2 renames, Delete removes"));
  list_->setEditTriggers(QAbstractItemView::EditKeyPressed);
  list_->setTextElideMode(Qt::ElideRight);
  list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  list_->installEventFilter(this);
  const auto jump = [this](const QListWidgetItem* item) {
    const auto row = static_cast<std::size_t>(list_->row(item));
    if (row < editor_.draft().landmarks.size()) Q_EMIT place_requested(editor_.draft().landmarks[row].p_P);
  };
  connect(list_, &QListWidget::itemClicked, this, jump);
  connect(list_, &QListWidget::itemActivated, this, jump);
  connect(list_, &QListWidget::itemChanged, this, [this](QListWidgetItem* item) {
    if (!is_refreshing_) rename(list_->row(item));
  });
  connect(list_, &QListWidget::currentRowChanged, this, [this](int row) {
    rename_->setEnabled(row >= 0);
    remove_->setEnabled(row >= 0);
  });
  qobject_cast<QVBoxLayout*>(layout())->addWidget(list_, 1);
}

void CaseLandmarks::add_buttons() {
  auto* row = new QHBoxLayout;
  rename_ = make_button("case-landmark-rename", tr("Rename"), tr("Rename the selected landmark  (F2)"));
  remove_ = make_button("case-landmark-remove", tr("Remove"), tr("Remove the selected landmark  (Delete)"));
  for (QPushButton* button : {rename_, remove_}) {
    button->setEnabled(false);
    row->addWidget(button);
  }
  connect(rename_, &QPushButton::clicked, this, [this] {
    if (list_->currentItem() != nullptr) list_->editItem(list_->currentItem());
  });
  connect(remove_, &QPushButton::clicked, this, &CaseLandmarks::remove_current);
  qobject_cast<QVBoxLayout*>(layout())->addLayout(row);
}

std::string CaseLandmarks::name() const {
  return landmark_of(name_->currentText());
}

void CaseLandmarks::show_picking(bool is_on) {
  pick_->setChecked(is_on);
}

void CaseLandmarks::rename(int row) {
  const std::string name = landmark_of(list_->item(row)->text());
  const auto at = static_cast<std::size_t>(row);
  if (at >= editor_.draft().landmarks.size() || name == editor_.draft().landmarks[at].name) return refresh();
  if (!editor_.edit(case_builder::rename_landmark(editor_.draft(), at, name), "rename a landmark")) refresh();
}

void CaseLandmarks::remove_current() {
  if (list_->currentRow() < 0) return;
  editor_.edit(case_builder::remove_landmark(editor_.draft(), static_cast<std::size_t>(list_->currentRow())),
               "remove a landmark");
}

bool CaseLandmarks::eventFilter(QObject* watched, QEvent* event) {
  if (watched == list_ && event->type() == QEvent::KeyPress &&
      static_cast<QKeyEvent*>(event)->key() == Qt::Key_Delete) {
    remove_current();
    return true;
  }
  return QWidget::eventFilter(watched, event);
}

void CaseLandmarks::refresh() {
  is_refreshing_ = true;
  const auto& landmarks = editor_.draft().landmarks;
  const int current = list_->currentRow();
  while (list_->count() > static_cast<int>(landmarks.size())) delete list_->takeItem(list_->count() - 1);
  for (std::size_t n = 0; n < landmarks.size(); ++n) {
    if (static_cast<int>(n) == list_->count()) {
      auto* item = new QListWidgetItem(list_);
      item->setFlags(item->flags() | Qt::ItemIsEditable);
    }
    const Vec3& p_P = landmarks[n].p_P;
    list_->item(static_cast<int>(n))->setText(landmark_text(landmarks[n].name));
    list_->item(static_cast<int>(n))
        ->setToolTip(QStringLiteral("%1 (%2, %3, %4) mm")
                         .arg(landmark_text(landmarks[n].name))
                         .arg(p_P.x(), 0, 'f', 0)
                         .arg(p_P.y(), 0, 'f', 0)
                         .arg(p_P.z(), 0, 'f', 0));
  }
  list_->setCurrentRow(std::min(current, list_->count() - 1));
  is_refreshing_ = false;
}

}  // namespace trocar::trainer
