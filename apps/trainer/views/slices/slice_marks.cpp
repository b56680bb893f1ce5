#include "views/slices/slice_marks.h"

#include <QEvent>
#include <QPainter>
#include <QPen>
#include <algorithm>
#include <cmath>

#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "ui_kit/window_language.h"
#include "views/slices/slice_canvas.h"
#include "views/slices/slice_view.h"

namespace trocar::trainer {
namespace {

constexpr double kNear_mm = 15.0;  ///< Landmarks farther from the slice are not drawn.

}  // namespace

QRectF free_place(QRectF wanted, std::span<const QRectF> taken) {
  const auto overlaps = [&](const QRectF& other) { return other.intersects(wanted); };
  for (auto other = std::ranges::find_if(taken, overlaps); other != taken.end();
       other = std::ranges::find_if(taken, overlaps))
    wanted.moveTop(other->bottom());
  return wanted;
}

SliceMarks::SliceMarks(SliceView* view) : QWidget(view), view_(view) {
  setAttribute(Qt::WA_TransparentForMouseEvents);
  setFocusPolicy(Qt::NoFocus);
  resize(view->size());
  view->installEventFilter(this);
}

bool SliceMarks::eventFilter(QObject* watched, QEvent* event) {
  if (watched == view_ && event->type() == QEvent::Resize) resize(view_->size());
  return QWidget::eventFilter(watched, event);
}

void SliceMarks::set_target(const std::optional<Vec3>& p_P) {
  if (p_P == target_A_) return;
  target_A_ = p_P;
  update();
}

void SliceMarks::set_landmarks(const std::vector<anatomy::Landmark>& landmarks) {
  landmarks_ = landmarks;
  update();
}

void SliceMarks::set_shot(const std::optional<Segment>& stylet_P, const std::optional<Segment>& core_P) {
  stylet_P_ = stylet_P;
  core_P_ = core_P;
  update();
}

void SliceMarks::set_throw(const std::optional<Segment>& throw_P, const std::optional<Segment>& notch_P) {
  throw_P_ = throw_P;
  notch_P_ = notch_P;
  update();
}

void SliceMarks::set_skin_marks(const std::vector<Vec3>& marks_P) {
  if (marks_P == skin_marks_P_) return;
  skin_marks_P_ = marks_P;
  update();
}

void SliceMarks::draw_piece(QPainter& painter, const Segment& piece_P, const QColor& color, double width,
                            Qt::PenStyle style) const {
  const bool is_near = std::max(away_mm(piece_P.a), away_mm(piece_P.b)) < kNear_mm;
  QColor shown = color;
  shown.setAlphaF(is_near ? 1.0F : 0.45F);
  painter.setPen(QPen(shown, width, style, Qt::FlatCap));
  painter.drawLine(view_->position_of(piece_P.a), view_->position_of(piece_P.b));
}

double SliceMarks::away_mm(const Vec3& p_P) const {
  return std::abs((p_P - view_->geometry().center_P).dot(view_->geometry().axes.normal_P()));
}

void SliceMarks::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setClipRect(view_->picture_rect());
  const auto pen_of = [](QColor color, double width, bool is_near) {
    color.setAlphaF(is_near ? 1.0F : 0.45F);
    return QPen(color, width, is_near ? Qt::SolidLine : Qt::DashLine);
  };
  constexpr double kStylet_px = 2.0, kCore_px = 4.0, kThrow_px = 1.0, kNotch_px = 3.0;
  if (throw_P_) draw_piece(painter, *throw_P_, theme().needle, kThrow_px, Qt::DashLine);
  if (notch_P_) draw_piece(painter, *notch_P_, theme().needle, kNotch_px, Qt::DotLine);
  if (stylet_P_) draw_piece(painter, *stylet_P_, theme().needle, kStylet_px);
  if (core_P_) draw_piece(painter, *core_P_, theme().target, kCore_px);
  for (const Vec3& mark_P : skin_marks_P_) {
    if (away_mm(mark_P) > kNear_mm) continue;
    painter.setPen(QPen(QColor(0, 0, 0, 200), 1.0));
    painter.setBrush(QColor(0x9a, 0x4d, 0xff));
    painter.drawEllipse(view_->position_of(mark_P), 4.0, 4.0);
    painter.setBrush(Qt::NoBrush);
  }
  std::vector<QRectF> names;
  const QFontMetricsF metrics(painter.font());
  for (const anatomy::Landmark& landmark : landmarks_) {
    const Vec3 p_P = view_->motion().to_now(landmark.p_P);
    const double away = away_mm(p_P);
    if (away > kNear_mm) continue;
    const QPointF at = view_->position_of(p_P);
    painter.setPen(pen_of(theme().warning, 1.5, away < kInPlane_mm));
    painter.drawLine(at - QPointF(4, 4), at + QPointF(4, 4));
    painter.drawLine(at - QPointF(4, -4), at + QPointF(4, -4));
    const QString name = shown(landmark.name);
    const QSizeF size(metrics.horizontalAdvance(name), metrics.height());
    const QRectF place = free_place(QRectF(at + QPointF(7.0, 4.0 - metrics.ascent()), size), names);
    names.push_back(place);
    draw_text(painter, place.topLeft() + QPointF(0.0, metrics.ascent()), name, painter.pen().color());
  }
  if (target_A_) {
    const Vec3 target_P = view_->motion().to_now(*target_A_);
    const QPointF at = view_->position_of(target_P);
    painter.setPen(pen_of(theme().target, 2.0, away_mm(target_P) < kInPlane_mm));
    painter.drawEllipse(at, 7.0, 7.0);
    painter.drawLine(at - QPointF(11, 0), at - QPointF(4, 0));
    painter.drawLine(at + QPointF(4, 0), at + QPointF(11, 0));
    painter.drawLine(at - QPointF(0, 11), at - QPointF(0, 4));
    painter.drawLine(at + QPointF(0, 4), at + QPointF(0, 11));
  }
}

}  // namespace trocar::trainer
