#include "panels/core_picture.h"

#include <QPainter>
#include <algorithm>

#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

constexpr scoring::CorePart kParts[] = {scoring::CorePart::kTarget, scoring::CorePart::kOrgan,
                                        scoring::CorePart::kVessel, scoring::CorePart::kOther};

constexpr int kBarGap = 6;  ///< Pixels.

QString title_of(scoring::CorePart part) {
  switch (part) {
    case scoring::CorePart::kTarget:
      return CorePicture::tr("target tissue");
    case scoring::CorePart::kOrgan:
      return CorePicture::tr("organ");
    case scoring::CorePart::kVessel:
      return CorePicture::tr("vessel");
    case scoring::CorePart::kOther:
      break;
  }
  return CorePicture::tr("other tissue");
}

}  // namespace

QColor CorePicture::color_of(scoring::CorePart part) {
  switch (part) {
    case scoring::CorePart::kTarget:
      return theme().target;
    case scoring::CorePart::kOrgan:
      return {0xb5, 0x6a, 0x55};
    case scoring::CorePart::kVessel:
      return {0x5b, 0x8d, 0xef};
    case scoring::CorePart::kOther:
      break;
  }
  return {0xd9, 0xc7, 0x8a};
}

CorePicture::CorePicture(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("core-picture"));
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void CorePicture::set_shots(std::span<const attempt::GunShot> shots) {
  cores_.clear();
  for (const attempt::GunShot& shot : shots) cores_.push_back(shot.pieces);
  legend_.clear();
  for (const scoring::CorePart part : kParts) {
    double length_mm = 0.0;
    for (const auto& pieces : cores_)
      for (const attempt::ShotPiece& piece : pieces)
        if (piece.part == part) length_mm += piece.to_mm - piece.from_mm;
    if (length_mm > 0.0) legend_.push_back({part, tr("%1 mm %2").arg(length_mm, 0, 'f', 1).arg(title_of(part))});
  }
  if (legend_.empty()) legend_.push_back({scoring::CorePart::kOther, tr("No tissue in the notch")});
  QStringList texts;
  for (const Entry& entry : legend_) texts << entry.text;
  const QString name = cores_.size() > 1 ? tr("%1 cores").arg(cores_.size()) : tr("Core");
  setAccessibleName(QStringLiteral("%1: %2").arg(name, texts.join(QStringLiteral(", "))));
  updateGeometry();
  update();
}

int CorePicture::bar_height() const {
  return fontMetrics().height();
}

QSize CorePicture::sizeHint() const {
  const int rows = std::max(1, static_cast<int>(legend_.size()));
  const int bars = std::max(1, static_cast<int>(cores_.size()));
  return {fontMetrics().averageCharWidth() * 24, bars * (bar_height() + kBarGap) + rows * fontMetrics().lineSpacing()};
}

void CorePicture::paint_bar(QPainter& painter, const std::vector<attempt::ShotPiece>& pieces, int top) const {
  const QRectF bar(0.5, top + 0.5, width() - 1.0, bar_height() - 1.0);
  const double whole_mm = pieces.empty() ? 0.0 : pieces.back().to_mm;
  for (const attempt::ShotPiece& piece : pieces) {
    const double from = bar.left() + bar.width() * piece.from_mm / whole_mm;
    const double to = bar.left() + bar.width() * piece.to_mm / whole_mm;
    painter.fillRect(QRectF(from, bar.top(), to - from, bar.height()), color_of(piece.part));
  }
  painter.setPen(theme().line);
  painter.drawRect(bar);
}

void CorePicture::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  int top = 0;
  for (const auto& pieces : cores_) {
    paint_bar(painter, pieces, top);
    top += bar_height() + kBarGap;
  }
  const bool is_empty = std::all_of(cores_.begin(), cores_.end(), [](const auto& pieces) { return pieces.empty(); });
  const int line = fontMetrics().lineSpacing();
  for (const Entry& entry : legend_) {
    const int side = line * 2 / 3;
    if (!is_empty) painter.fillRect(QRect(0, top + (line - side) / 2, side, side), color_of(entry.part));
    painter.setPen(theme().dim);
    painter.drawText(QRect(is_empty ? 0 : line, top, width() - line, line), Qt::AlignVCenter, entry.text);
    top += line;
  }
}

}  // namespace trocar::trainer
