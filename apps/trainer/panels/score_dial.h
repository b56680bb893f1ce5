#pragma once

#include <QWidget>

namespace trocar::trainer {

/// A score as a ring with its number, coloured by its value.
class ScoreDial : public QWidget {
  Q_OBJECT

 public:
  explicit ScoreDial(QWidget* parent = nullptr);
  void set_score(double score);  ///< 0..100
  QSize sizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  double score_ = 0.0;
};

/// A thin bar: points of a part of the score.
class PointsBar : public QWidget {
  Q_OBJECT

 public:
  PointsBar(double points, double most, QWidget* parent = nullptr);
  QSize sizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  double share_;
};

/// Green, amber or red for a share in 0..1.
QColor color_of_share(double share);

}  // namespace trocar::trainer
