#include "choice/trainer_choice.h"

#include <QCoreApplication>

#include "io/patient/patient_folder.h"

namespace trocar::trainer {
namespace {

class TrainerChoiceText {
  Q_DECLARE_TR_FUNCTIONS(TrainerChoiceText)
};

}  // namespace

bool needs_exam_body(const TrainerChoice& choice) {
  return choice.mode == TrainingMode::kExam && !io::is_path(choice.patient);
}

QString exam_text(const TrainerChoice& choice) {
  if (choice.mode != TrainingMode::kExam) return {};
  const bool is_folder = !needs_exam_body(choice);
  const bool is_found = choice.exam_number != 0 && choice.patient_seed == choice.exam_number;
  if (!is_folder && !is_found) return {};  // it is being drawn
  QString text = TrainerChoiceText::tr("The case is known: a patient folder has no unseen variant.");
  if (!is_folder)
    text = choice.is_body_known
               ? TrainerChoiceText::tr("Exam %1: this body is known from an earlier attempt.").arg(choice.exam_number)
               : TrainerChoiceText::tr("Exam %1: an unseen body.").arg(choice.exam_number);
  if (choice.is_person_named) return text;
  return text + QLatin1Char(' ') +
         TrainerChoiceText::tr("The result will name nobody: go back and choose who you are on the start page.");
}

}  // namespace trocar::trainer
