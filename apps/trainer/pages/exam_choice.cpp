#include "pages/exam_choice.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QSpinBox>
#include <QVBoxLayout>
#include <algorithm>

#include "exams/exam_body.h"
#include "io/patient/patient_folder.h"
#include "ui_kit/parts.h"

namespace trocar::trainer {

ExamChoice::ExamChoice(QWidget* parent) : QWidget(parent) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(24, 0, 0, 0);
  column->setSpacing(6);
  auto* row = new QHBoxLayout;
  row->addWidget(make_label(tr("Difficulty"), "dim"));
  difficulty_ = new QComboBox;
  difficulty_->setObjectName(QStringLiteral("exam-difficulty"));
  difficulty_->setAccessibleName(tr("Difficulty of the exam"));
  difficulty_->setToolTip(tr("Difficulty, 1 (easiest) to 5; – is not graded"));
  difficulty_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  row->addWidget(difficulty_, 1);
  row->addWidget(make_label(tr("No."), "dim"));
  number_ = new QSpinBox;
  number_->setObjectName(QStringLiteral("exam-number"));
  number_->setAccessibleName(tr("Number of the exam"));
  number_->setRange(static_cast<int>(exams::kPractisedNumber), static_cast<int>(exams::kMostNumber));
  number_->setSpecialValueText(tr("drawn"));  // the practised body is never an exam
  number_->setButtonSymbols(QAbstractSpinBox::NoButtons);
  number_->setToolTip(tr("The same number is the same body for everyone; 1 draws one that was not practised here"));
  row->addWidget(number_, 1);
  column->addLayout(row);
  column->addWidget(make_label(tr("Needle and forces are those of the task."), "dim"));
  note_ = make_label(tr("A patient folder has no unseen variant: the result says that the case is known."), "dim");
  note_->setWordWrap(true);
  column->addWidget(note_);
  connect(difficulty_, QOverload<int>::of(&QComboBox::activated), this,
          [this](int index) { Q_EMIT difficulty_chosen(difficulty_->itemData(index).toInt()); });
}

void ExamChoice::show_patients(const std::vector<PatientEntry>& entries) {
  std::vector<int> difficulties;
  for (const PatientEntry& entry : entries)
    if (!io::is_path(to_std(entry.source))) difficulties.push_back(entry.difficulty);
  std::sort(difficulties.begin(), difficulties.end());
  difficulties.erase(std::unique(difficulties.begin(), difficulties.end()), difficulties.end());
  difficulty_->clear();
  for (const int difficulty : difficulties)
    difficulty_->addItem(difficulty > 0 ? tr("%1 of 5").arg(difficulty) : QString(QChar(0x2013)), difficulty);
}

void ExamChoice::show_patient(const PatientEntry* patient) {
  const bool is_folder = patient != nullptr && io::is_path(to_std(patient->source));
  difficulty_->setCurrentIndex(patient == nullptr || is_folder ? -1 : difficulty_->findData(patient->difficulty));
  number_->setEnabled(!is_folder);
  note_->setVisible(is_folder);
}

void ExamChoice::set_number(std::uint64_t number) {
  number_->setValue(static_cast<int>(std::clamp(number, exams::kPractisedNumber, exams::kMostNumber)));
}

std::uint64_t ExamChoice::number() const {
  const auto number = static_cast<std::uint64_t>(number_->value());
  return number_->isEnabled() && number != exams::kPractisedNumber ? number : 0;
}

}  // namespace trocar::trainer
