#include "views/plots/player_icons.h"

#include <QPainter>
#include <QPainterPath>

#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

/// Shape in a unit square.
QPainterPath shape_of(PlayerIcon icon) {
  QPainterPath path;
  const auto triangle = [&](double back, double tip) {
    path.addPolygon(QPolygonF({{back, 0.1}, {tip, 0.5}, {back, 0.9}}));
    path.closeSubpath();
  };
  switch (icon) {
    case PlayerIcon::kPlay:
      triangle(0.2, 0.9);
      break;
    case PlayerIcon::kPause:
      path.addRect(0.2, 0.1, 0.2, 0.8);
      path.addRect(0.6, 0.1, 0.2, 0.8);
      break;
    case PlayerIcon::kPrevious:
      triangle(0.85, 0.3);
      path.addRect(0.15, 0.1, 0.13, 0.8);
      break;
    case PlayerIcon::kNext:
      triangle(0.15, 0.7);
      path.addRect(0.72, 0.1, 0.13, 0.8);
      break;
  }
  return path;
}

QPixmap painted(PlayerIcon icon, int side, const QColor& color) {
  QPixmap pixmap(side, side);
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.scale(side, side);
  painter.fillPath(shape_of(icon), color);
  return pixmap;
}

}  // namespace

QIcon player_icon(PlayerIcon icon) {
  QIcon all;
  for (const int side : {16, 32, 64}) {  // also for screens with two or four pixels per point
    all.addPixmap(painted(icon, side, theme().text), QIcon::Normal);
    all.addPixmap(painted(icon, side, theme().line), QIcon::Disabled);
  }
  return all;
}

}  // namespace trocar::trainer
