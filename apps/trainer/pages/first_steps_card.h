#pragma once

#include <QFrame>

#include "choice/trainer_choice.h"

namespace trocar::trainer {

/// Offers a new user a guided first puncture on a simple body. Hidden once it was done or skipped (stored).
class FirstStepsCard : public QFrame {
  Q_OBJECT

 public:
  explicit FirstStepsCard(QWidget* parent = nullptr);

  /// The guided first puncture: a task of its own on a block of tissue.
  static TrainerChoice exercise();
  /// Stores that it need not be offered any more.
  void set_done();

 Q_SIGNALS:
  void exercise_requested(const trocar::trainer::TrainerChoice& exercise);
  void done();
};

}  // namespace trocar::trainer
