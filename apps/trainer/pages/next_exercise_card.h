#pragma once

#include <QFrame>

#include "choice/trainer_choice.h"

class QLabel;

namespace trocar::trainer {

/// The next exercise of the learning path with its reasons, and a button that starts it. Hidden until there is one.
class NextExerciseCard : public QFrame {
  Q_OBJECT

 public:
  explicit NextExerciseCard(QWidget* parent = nullptr);

  /// `title`: "Liver biopsy, case 2, assisted"; empty: hides the card.
  void offer(const QString& title, const QString& why, const TrainerChoice& exercise);
  /// Hides the card while something else comes first.
  void set_held_back(bool is_held_back);

 Q_SIGNALS:
  void exercise_requested(const trocar::trainer::TrainerChoice& exercise);

 private:
  QLabel* title_ = nullptr;
  QLabel* why_ = nullptr;
  TrainerChoice exercise_;
  bool has_exercise_ = false, is_held_back_ = false;
};

}  // namespace trocar::trainer
