#pragma once

#include <QRectF>
#include <QWidget>
#include <optional>
#include <span>
#include <vector>

#include "anatomy/patient.h"
#include "geometry/shapes.h"

class QPainter;

namespace trocar::trainer {

class SliceView;

/// Place of a text, pixels: the wanted one, moved down until it overlaps none of the others.
QRectF free_place(QRectF wanted, std::span<const QRectF> taken);

/// Overlay of a slice viewer with the marks of a case besides the plan (target, landmarks), the gun's shot and its
/// throw; faint if they are off the slice. Transparent for the mouse.
class SliceMarks : public QWidget {
  Q_OBJECT

 public:
  explicit SliceMarks(SliceView* view);

  void set_target(const std::optional<Vec3>& p_P);
  void set_shot(const std::optional<Segment>& stylet_P, const std::optional<Segment>& core_P);
  /// Way of the stylet if the gun were fired now, and the notch's part of it.
  void set_throw(const std::optional<Segment>& throw_P, const std::optional<Segment>& notch_P);
  /// Dots of a skin marker.
  void set_skin_marks(const std::vector<Vec3>& marks_P);
  void set_landmarks(const std::vector<anatomy::Landmark>& landmarks);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  /// Distance from the slice's plane, mm.
  double away_mm(const Vec3& p_P) const;
  void draw_piece(QPainter& painter, const Segment& piece_P, const QColor& color, double width,
                  Qt::PenStyle style = Qt::SolidLine) const;

  SliceView* view_;
  std::optional<Vec3> target_A_;
  std::optional<Segment> stylet_P_, core_P_, throw_P_, notch_P_;
  std::vector<Vec3> skin_marks_P_;
  std::vector<anatomy::Landmark> landmarks_;
};

}  // namespace trocar::trainer
