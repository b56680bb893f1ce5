#include "views/ultrasound/pose_picture.h"

#include <QPainter>
#include <algorithm>

#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

constexpr double kHalf_mm = 150.0;   ///< Displayed range to each side of the workspace's centre.
constexpr double kStylus_mm = 60.0;  ///< Length of the drawn stylus.
constexpr double kGrip_px = 5.0;

}  // namespace

PosePicture::PosePicture(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("device-pose-picture"));
  setMinimumSize(380, 190);
}

void PosePicture::show_pose(const Vec3& p_D, const Vec3& axis_D, bool is_known) {
  p_D_ = p_D;
  axis_D_ = axis_D;
  is_known_ = is_known;
  update();
}

void PosePicture::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const double side = std::min(0.5 * width() - 6.0, height() - 4.0);
  const double px_per_mm = 0.5 * side / kHalf_mm;
  const std::pair<QString, int> views[] = {{tr("from above"), 1}, {tr("from the front"), 2}};
  double left = 0.0;
  for (const auto& [title, up] : views) {
    const QRectF box(left + 2.0, 2.0, side, side);
    left += 0.5 * width();
    painter.setPen(theme().line);
    painter.setBrush(theme().view);
    painter.drawRect(box);
    painter.setPen(theme().dim);
    painter.drawText(box.adjusted(6, 4, -6, -4), Qt::AlignTop | Qt::AlignLeft, title);
    if (!is_known_) continue;
    painter.setClipRect(box);
    const auto at = [&, up = up](const Vec3& p) {
      return box.center() + QPointF(px_per_mm * p.x(), -px_per_mm * p[up]);
    };
    painter.setPen(QPen(theme().accent, 3.0));
    painter.drawLine(at(p_D_), at(p_D_ + kStylus_mm * axis_D_));
    painter.setBrush(theme().accent);
    painter.drawEllipse(at(p_D_), kGrip_px, kGrip_px);
    painter.setClipping(false);
  }
}

}  // namespace trocar::trainer
