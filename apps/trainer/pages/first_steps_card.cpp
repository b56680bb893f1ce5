#include "pages/first_steps_card.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSettings>
#include <QVBoxLayout>

#include "core/files/folders.h"
#include "ui_kit/parts.h"

namespace trocar::trainer {
namespace {

constexpr const char* kDone = "start/first-steps-done";

}  // namespace

FirstStepsCard::FirstStepsCard(QWidget* parent) : QFrame(parent) {
  setObjectName(QStringLiteral("first-steps"));
  setProperty("role", "card");
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(16, 8, 16, 8);
  auto* texts = new QVBoxLayout;
  texts->setSpacing(2);
  texts->addWidget(make_label(tr("New here? Your first puncture, in about three minutes"), "heading"));
  auto* text = make_label(
      tr("Six steps on a block of tissue: move, touch, press, feel a layer, reach the target, withdraw."), "dim");
  text->setWordWrap(true);
  texts->addWidget(text);
  row->addLayout(texts, 1);
  auto* skip =
      make_button("first-steps-skip", tr("Skip"), tr("Do not offer it any more; First steps, below, starts it"));
  auto* start = make_button("first-steps-start", tr("Begin with it"), tr("Open the block of tissue"));
  start->setProperty("role", "primary");
  row->addWidget(skip);
  row->addWidget(start);
  connect(skip, &QPushButton::clicked, this, &FirstStepsCard::set_done);
  connect(start, &QPushButton::clicked, this, [this] { Q_EMIT exercise_requested(exercise()); });
  if (QSettings().value(QString::fromLatin1(kDone)).toBool()) hide();
}

TrainerChoice FirstStepsCard::exercise() {
  TrainerChoice choice;
  choice.task = (data_dir() / "tutorial" / "first-puncture.toml").string();
  choice.patient = "layers-liver";
  choice.is_tutorial = true;
  return choice;
}

void FirstStepsCard::set_done() {
  QSettings().setValue(QString::fromLatin1(kDone), true);
  hide();
  Q_EMIT done();
}

}  // namespace trocar::trainer
