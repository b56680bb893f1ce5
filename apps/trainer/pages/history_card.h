#pragma once

#include <QFrame>

#include "results/proficiency.h"

class QLabel;

namespace trocar::trainer {

class CurvePlot;

/// A person's history at the selected task: learning curve, and the comparison with the others and the experts in
/// words. Hidden while nobody practises.
class HistoryCard : public QFrame {
  Q_OBJECT

 public:
  explicit HistoryCard(QWidget* parent = nullptr);

  void show_history(const results::LearningCurve& curve);
  void clear();

 private:
  CurvePlot* plot_ = nullptr;
  QLabel* text_ = nullptr;
};

/// "12 attempts, 7 passed. Last 5: 74. Others after 12 attempts: 68 (8 people). Experts: 96 to 100."
QString history_text(const results::LearningCurve& curve);
/// After an attempt: "Your attempt 12: 74 points. …" Empty: the last attempt has no score.
QString comparison_text(const results::LearningCurve& curve);

}  // namespace trocar::trainer
