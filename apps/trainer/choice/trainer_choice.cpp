#include "choice/trainer_choice.h"

#include <QCoreApplication>

#include "io/patient/patient_source.h"

namespace trocar::trainer {
namespace {

QString choice_tr(const char* text) {
  return QCoreApplication::translate("TrainerChoice", text);
}

}  // namespace

bool needs_exam_body(const TrainerChoice& choice) {
  return choice.difficulty == Difficulty::kExam && !io::is_path(choice.patient);
}

QString exam_text(const TrainerChoice& choice) {
  if (choice.difficulty != Difficulty::kExam) return {};
  if (!needs_exam_body(choice)) return choice_tr("The case is known: a patient folder has no unseen variant.");
  const bool is_found = choice.exam_number != 0 && choice.patient_seed == choice.exam_number;
  if (!is_found) return {};  // it is being drawn
  return choice.is_body_known
             ? choice_tr("Exam %1: this body is known from an earlier attempt.").arg(choice.exam_number)
             : choice_tr("Exam %1: an unseen body.").arg(choice.exam_number);
}

}  // namespace trocar::trainer
