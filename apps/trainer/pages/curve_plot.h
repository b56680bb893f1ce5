#pragma once

#include <QWidget>

#include "results/proficiency.h"

namespace trocar::trainer {

/// Scores of a person at a task by attempt: points, their moving mean, the mean of the others at the same attempt, the
/// range of the experts. Horizontal: scored attempts; vertical: 0 to 100 points.
class CurvePlot : public QWidget {
  Q_OBJECT

 public:
  explicit CurvePlot(QWidget* parent = nullptr);

  void show_curve(const results::LearningCurve& curve);
  void clear();
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QRectF plot_area() const;
  double y_of(double score) const;

  struct Point {
    std::optional<double> score;  ///< Empty: without a result; drawn at 0.
    std::optional<double> mean;
    bool is_passed = false;
  };
  std::vector<Point> points_;
  std::vector<std::optional<double>> peers_;
  std::optional<results::ExpertLevel> experts_;
};

}  // namespace trocar::trainer
