#pragma once

#include <QWidget>
#include <optional>
#include <vector>

#include "anatomy/patient.h"
#include "geometry/segment.h"

class QPainter;

namespace trocar::trainer {

class SliceView;

/// Lies over a slice viewer and marks what a case is made of beside the plan, the target and landmarks, and the shot of
/// a gun; faint where they lie beside the slice. Lets the mouse through.
class SliceMarks : public QWidget {
  Q_OBJECT

 public:
  explicit SliceMarks(SliceView* view);

  void set_target(const std::optional<Vec3>& p_P);
  void set_shot(const std::optional<Segment>& stylet_P, const std::optional<Segment>& core_P);
  void set_landmarks(const std::vector<anatomy::Landmark>& landmarks);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  /// Away from the slice's plane, mm.
  double away_mm(const Vec3& p_P) const;
  void draw_piece(QPainter& painter, const Segment& piece_P, const QColor& color, double width) const;

  SliceView* view_;
  std::optional<Vec3> target_P_;
  std::optional<Segment> stylet_P_, core_P_;
  std::vector<anatomy::Landmark> landmarks_;
};

}  // namespace trocar::trainer
