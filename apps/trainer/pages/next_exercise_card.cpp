#include "pages/next_exercise_card.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "ui_kit/parts.h"

namespace trocar::trainer {

NextExerciseCard::NextExerciseCard(QWidget* parent) : QFrame(parent) {
  setObjectName(QStringLiteral("next-exercise"));
  setProperty("role", "card");
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(16, 8, 16, 8);
  auto* texts = new QVBoxLayout;
  texts->setSpacing(2);
  title_ = make_label({}, "heading");
  title_->setObjectName(QStringLiteral("next-exercise-title"));
  why_ = make_label({}, "dim");
  why_->setObjectName(QStringLiteral("next-exercise-why"));
  why_->setWordWrap(true);
  texts->addWidget(title_);
  texts->addWidget(why_);
  row->addLayout(texts, 1);
  auto* start = make_button("start-next", tr("Start it"), Action::kStartProposal);
  row->addWidget(start);
  connect(start, &QPushButton::clicked, this, [this] { Q_EMIT exercise_requested(exercise_); });
  hide();
}

void NextExerciseCard::offer(const QString& title, const QString& why, const TrainerChoice& exercise) {
  exercise_ = exercise;
  title_->setText(tr("Next exercise: %1").arg(title));
  why_->setText(why);
  has_exercise_ = !title.isEmpty();
  setVisible(has_exercise_ && !is_held_back_);
}

void NextExerciseCard::set_held_back(bool is_held_back) {
  is_held_back_ = is_held_back;
  setVisible(has_exercise_ && !is_held_back_);
}

}  // namespace trocar::trainer
