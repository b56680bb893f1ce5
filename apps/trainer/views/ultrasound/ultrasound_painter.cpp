#include "views/ultrasound/ultrasound_painter.h"

#include <QCoreApplication>
#include <QFontMetricsF>
#include <QImage>
#include <QPainter>
#include <algorithm>
#include <cmath>
#include <variant>

#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "ui_kit/window_language.h"
#include "ultrasound/doppler/colour_doppler.h"

namespace trocar::trainer {
namespace {

class UltrasoundPainter {
  Q_DECLARE_TR_FUNCTIONS(UltrasoundPainter)
};

const QColor kInk(0xc8, 0xce, 0xd6);
const QColor kMarkerInk(0x5a, 0xc8, 0x78);
const QColor kFocusInk(0xf0, 0xc8, 0x50);
const QColor kCaliperInk(0xf4, 0xe0, 0x6a);

constexpr double kLeastRate_hz = 0.05;             ///< Rounds to 0.1; an image at rest has no rate.
constexpr double kHardlyAny = 0.02, kMost = 0.75;  ///< Shares of the face on the skin, as in the command line.
constexpr double kUnscanned = 0.01;                ///< Share of the image outside the CT that needs a caption.
constexpr double kWedge_px = 8.0, kBarGap_px = 12.0, kColourBar_px = 10.0;
constexpr int kOutlinePoints = 72;
constexpr double kCross_px = 5.0;
constexpr double kMarkerBeside_px = 8.0;  ///< Largest distance of the marker from the raster.

double line_height(const QFont& font) {
  return std::ceil(QFontMetricsF(font).height() * 1.05);
}

QFont bold(QFont font) {
  font.setBold(true);
  return font;
}

/// Text next to a mark, with a dark outline for legibility on bright tissue.
void draw_tag(QPainter& painter, const QPointF& at, const QString& text) {
  const QPen ink = painter.pen();
  painter.setPen(QColor(0, 0, 0, 200));
  for (const QPointF& d : {QPointF(-1, 0), QPointF(1, 0), QPointF(0, -1), QPointF(0, 1)})
    painter.drawText(at + d, text);
  painter.setPen(ink);
  painter.drawText(at, text);
}

}  // namespace

void draw_cross(QPainter& painter, const QPointF& at, double size) {
  painter.drawLine(at - QPointF(size, 0), at + QPointF(size, 0));
  painter.drawLine(at - QPointF(0, size), at + QPointF(0, size));
}

QPen dotted_pen(const QColor& color, double width) {
  QPen pen(color, width, Qt::CustomDashLine, Qt::RoundCap);
  pen.setDashPattern({0.1, 3.0});
  return pen;
}

std::vector<CaptionLine> caption_of(const ultrasound::ScanPicture& picture, const CaptionFacts& facts) {
  using Kind = CaptionLine::Kind;
  ultrasound::ScanCaption caption;
  caption.transducer = to_std(facts.transducer);
  caption.frequency_mhz = picture.acquisition.frequency_mhz;
  caption.is_harmonic = picture.acquisition.is_harmonic;
  caption.focus_mm = picture.acquisition.focus_mm;
  caption.settings = picture.display;
  const ultrasound::ScanAnnotation annotation = ultrasound::make_scan_annotation(picture.raster, picture.scan, caption);
  std::vector<CaptionLine> lines;
  for (const ultrasound::ScanAnnotation::Text& text : annotation.texts)
    if (text.column < annotation.scale_column) lines.push_back({shown(text.text), Kind::kPlain});
  if (!lines.empty()) lines.front().kind = Kind::kName;
  if (facts.is_small) lines.resize(std::min<std::size_t>(lines.size(), 1));
  if (facts.output) {
    const double transmitted_mhz = picture.acquisition.frequency_mhz * (picture.acquisition.is_harmonic ? 0.5 : 1.0);
    const ultrasound::AcousticIndices indices =
        ultrasound::acoustic_indices(*facts.output, transmitted_mhz, picture.acquisition.focus_mm);
    const QString mechanical = QStringLiteral("MI %L1").arg(indices.mechanical, 0, 'f', 1);
    // A small view has no room for a further line.
    if (facts.is_small && !lines.empty()) {
      lines.front().text += QStringLiteral(" ") + mechanical;
    } else {
      lines.push_back({QStringLiteral("%L1  TIS %L2").arg(mechanical).arg(indices.thermal, 0, 'f', 1), Kind::kPlain});
    }
  }
  if (facts.zoom > 1.0) lines.push_back({QStringLiteral("Zoom %L1x").arg(facts.zoom, 0, 'f', 1), Kind::kPlain});
  if (picture.is_frozen) {
    const QString state = facts.cine.is_playing ? UltrasoundPainter::tr("Cine") : UltrasoundPainter::tr("Frozen");
    lines.push_back(
        {QStringLiteral("%1 %2/%3").arg(state).arg(facts.cine.position + 1).arg(facts.cine.size), Kind::kFrozen});
  } else if (!facts.is_small && facts.frames_per_s >= kLeastRate_hz) {
    lines.push_back(
        {QStringLiteral("%L1 Hz").arg(facts.frames_per_s, 0, 'f', facts.frames_per_s < 1.0 ? 1 : 0), Kind::kPlain});
  }
  if (picture.coupled_share < kHardlyAny) {
    lines.push_back({UltrasoundPainter::tr("No contact"), Kind::kWarning});
  } else if (picture.coupled_share < kMost) {
    lines.push_back({UltrasoundPainter::tr("Poor contact"), Kind::kWarning});
  }
  if (picture.unscanned_share > kUnscanned) lines.push_back({UltrasoundPainter::tr("Outside CT"), Kind::kWarning});
  int number = 1;
  for (const ultrasound::Measurement& measurement : facts.measurements) {
    const std::vector<std::string> texts = ultrasound::results(measurement);
    for (std::size_t n = 0; n < texts.size(); ++n)
      lines.push_back(
          {(n == 0 ? QStringLiteral("%1  ").arg(number) : QStringLiteral("    ")) + shown(texts[n]), Kind::kResult});
    ++number;
  }
  return lines;
}

QFont caption_font(bool is_small) {
  return scaled_font(is_small ? 0.85 : 0.95);
}

QSizeF caption_size(const std::vector<CaptionLine>& lines, const QFont& font) {
  const QFontMetricsF metrics(bold(font));
  double width = 0.0;
  for (const CaptionLine& line : lines) width = std::max(width, metrics.horizontalAdvance(line.text));
  return {std::ceil(width), line_height(font) * static_cast<double>(lines.size())};
}

QSizeF bars_size(const QFont& font, double view_height, bool has_doppler) {
  const double height = std::clamp(0.24 * view_height, 48.0, 200.0);
  if (!has_doppler) return {kWedge_px, height};
  const double label = QFontMetricsF(font).horizontalAdvance(QStringLiteral("+100"));
  return {kWedge_px + kBarGap_px + std::max(label, kColourBar_px), height + 3.0 * line_height(font)};
}

void draw_message(QPainter& painter, const QRectF& picture, const QString& text, const QFont& font) {
  constexpr double kPadding_px = 8.0;
  const QFontMetricsF metrics(font);
  QRectF box = metrics.boundingRect(text).adjusted(-kPadding_px, -kPadding_px, kPadding_px, kPadding_px);
  box.moveCenter({picture.center().x(), picture.top() + box.height()});
  painter.fillRect(box, QColor(0, 0, 0, 180));
  painter.setFont(font);
  painter.setPen(theme().text);
  painter.drawText(box, Qt::AlignCenter, text);
}

void draw_caption(QPainter& painter, const QRectF& place, const std::vector<CaptionLine>& lines, const QFont& font,
                  bool is_on_image) {
  using Kind = CaptionLine::Kind;
  if (is_on_image) {
    constexpr double kRim_px = 4.0;
    painter.fillRect(QRectF(place.topLeft(), caption_size(lines, font)).adjusted(-kRim_px, -kRim_px, kRim_px, kRim_px),
                     QColor(0, 0, 0, 170));
  }
  double y = place.top() + QFontMetricsF(font).ascent();
  for (const CaptionLine& line : lines) {
    QColor ink = kInk;
    if (line.kind == Kind::kWarning) ink = theme().warning;
    if (line.kind == Kind::kResult) ink = kCaliperInk;
    if (line.kind == Kind::kFrozen) ink = theme().accent;
    if (line.kind == Kind::kName) ink = theme().text;
    painter.setFont(line.kind == Kind::kPlain || line.kind == Kind::kResult ? font : bold(font));
    painter.setPen(ink);
    painter.drawText(QPointF(place.left(), y), line.text);
    y += line_height(font);
  }
}

QPointF marker_place(const PictureMap& map, const ultrasound::ScanAnnotation& annotation) {
  // The pixels of a coarse raster are larger than those of the widget and would move the marker out of the view.
  const QPointF marker = map.pixel_to_view(annotation.marker_pixel);
  const QRectF room = map.rect().adjusted(-kMarkerBeside_px, -kMarkerBeside_px, kMarkerBeside_px, kMarkerBeside_px);
  return {std::clamp(marker.x(), room.left(), room.right()), std::clamp(marker.y(), room.top(), room.bottom())};
}

void draw_depth_scale(QPainter& painter, const PictureMap& map, double scale_x,
                      const ultrasound::ScanAnnotation& annotation, const QFont& font) {
  const QFontMetricsF metrics(font);
  painter.setFont(font);
  int longest = 1;
  for (const auto& tick : annotation.ticks) longest = std::max(longest, tick.length_px);
  const auto y_of = [&](double row) { return map.pixel_to_view({0.0, row}).y(); };
  const auto lowest = static_cast<double>(painter.viewport().height()) / painter.device()->devicePixelRatioF();
  const QRectF shown = map.area().adjusted(-kMarkerBeside_px, -kMarkerBeside_px, kMarkerBeside_px, kMarkerBeside_px);
  for (const auto& tick : annotation.ticks) {
    const double y = y_of(tick.row);
    if (map.is_magnified() && (y < map.area().top() || y > map.area().bottom())) continue;
    const bool is_long = tick.length_px == longest;
    painter.setPen(QPen(kInk, 1.0));
    painter.drawLine(QPointF(scale_x - (is_long ? 8.0 : 4.0), y), QPointF(scale_x, y));
    if (!is_long) continue;
    const QString label = QString::number(std::lround(tick.depth_mm / 10.0));
    const double base = std::clamp(y + 0.5 * metrics.capHeight(), metrics.ascent(), lowest - metrics.descent());
    painter.drawText(QPointF(scale_x + 5.0, base), label);
  }
  const double focus_y = y_of(annotation.focus_row);
  painter.setPen(Qt::NoPen);
  painter.setBrush(kFocusInk);
  const double tip_x = scale_x - 10.0;
  if (!map.is_magnified() || (focus_y >= map.area().top() && focus_y <= map.area().bottom()))
    painter.drawPolygon(
        QPolygonF({QPointF(tip_x, focus_y), QPointF(tip_x - 7.0, focus_y - 5.0), QPointF(tip_x - 7.0, focus_y + 5.0)}));
  painter.setBrush(kMarkerInk);
  const QPointF marker = marker_place(map, annotation);
  if (!map.is_magnified() || shown.contains(marker)) painter.drawEllipse(marker, kMarker_px, kMarker_px);
  painter.setBrush(Qt::NoBrush);
}

void draw_bars(QPainter& painter, const QRectF& place, const ultrasound::ScanAnnotation& annotation,
               const ultrasound::ScanPicture& picture, const QFont& font) {
  const bool has_doppler = picture.doppler_scale_cm_per_s > 0.0;
  const double above = has_doppler ? line_height(font) : 0.0;
  const double below = has_doppler ? 2.0 * line_height(font) : 0.0;
  const QRectF wedge(place.right() - kWedge_px, place.top() + above, kWedge_px, place.height() - above - below);
  const auto& gray = annotation.wedge.gray;
  const int levels = static_cast<int>(gray.size());
  if (levels > 0) {
    const QImage image(gray.data(), 1, levels, 1, QImage::Format_Grayscale8);
    painter.drawImage(wedge, image);
  }
  if (!has_doppler) return;
  const QRectF bar(place.left(), wedge.top(), kColourBar_px, wedge.height());
  constexpr int kRows = 128;
  QImage colours(1, kRows, QImage::Format_RGB32);
  const double b = picture.doppler.baseline;
  for (int r = 0; r < kRows; ++r) {
    const image::Rgb c = ultrasound::doppler_colour(b + 1.0 - 2.0 * (r + 0.5) / kRows, picture.doppler);
    colours.setPixelColor(0, r, QColor(c[0], c[1], c[2]));
  }
  painter.drawImage(bar, colours);
  painter.setFont(font);
  painter.setPen(kInk);
  const auto label = [&](double share) {
    const double value = share * picture.doppler_scale_cm_per_s;
    return QStringLiteral("%L1%L2").arg(value > 0.0 ? QStringLiteral("+") : QString()).arg(value, 0, 'f', 0);
  };
  const QFontMetricsF metrics(font);
  painter.drawText(QPointF(bar.left(), bar.top() - 0.5 * metrics.descent() - 2.0), label(b + 1.0));
  painter.drawText(QPointF(bar.left(), bar.bottom() + metrics.ascent()), label(b - 1.0));
  painter.drawText(QPointF(bar.left(), bar.bottom() + metrics.ascent() + line_height(font)), QStringLiteral("cm/s"));
}

namespace {

void draw_caliper_line(QPainter& painter, const QPointF& a, const QPointF& b, const QPen& line) {
  const QPen ink = painter.pen();
  painter.setPen(line);
  painter.drawLine(a, b);
  painter.setPen(ink);
}

void draw_outline(QPainter& painter, const PictureMap& map, const ultrasound::EllipseCaliper& ellipse,
                  const QPen& line) {
  QPolygonF outline;
  for (const ultrasound::Vec2& p_T : ellipse.outline_T(kOutlinePoints)) outline << map.to_view(p_T);
  const QPen ink = painter.pen();
  painter.setPen(line);
  painter.drawPolygon(outline);
  painter.setPen(ink);
}

/// Beside a mark, inside the picture.
void draw_result(QPainter& painter, const PictureMap& map, const QPointF& at, const QString& text) {
  constexpr double kBeside_px = 10.0;
  const QFontMetricsF metrics(painter.font());
  const double width = metrics.horizontalAdvance(text);
  const QRectF area = map.area();
  QPointF place = at + QPointF(kBeside_px, -kBeside_px);
  if (place.x() + width > area.right()) place.setX(at.x() - kBeside_px - width);
  if (place.y() - metrics.ascent() < area.top()) place.setY(at.y() + kBeside_px + metrics.ascent());
  draw_tag(painter, place, text);
}

}  // namespace

void draw_measurements(QPainter& painter, const PictureMap& map, std::span<const ultrasound::Measurement> measurements,
                       std::optional<std::size_t> chosen) {
  painter.setBrush(Qt::NoBrush);
  painter.setFont(caption_font(false));
  for (std::size_t n = 0; n < measurements.size(); ++n) {
    const ultrasound::Measurement& measurement = measurements[n];
    const bool is_chosen = chosen == n;
    const QPen line = dotted_pen(kCaliperInk, is_chosen ? 1.8 : 1.2);
    painter.setPen(QPen(kCaliperInk, is_chosen ? 1.8 : 1.2));
    std::vector<QPointF> marks;
    for (const ultrasound::Vec2& mark_T : marks_T(measurement)) marks.push_back(map.to_view(mark_T));
    if (const auto* ellipse = std::get_if<ultrasound::EllipseCaliper>(&measurement)) {
      draw_outline(painter, map, *ellipse, line);
    } else {
      for (std::size_t end = 1; end < marks.size(); ++end) draw_caliper_line(painter, marks[0], marks[end], line);
    }
    for (const QPointF& mark : marks) draw_cross(painter, mark, kCross_px);
    if (is_chosen)
      for (const QPointF& mark : marks) painter.drawEllipse(mark, kCross_px + 3.0, kCross_px + 3.0);
    const QPointF& last = marks[std::holds_alternative<ultrasound::AngleCaliper>(measurement) ? 2 : 1];
    draw_tag(painter, last + QPointF(kCross_px + (is_chosen ? 6.0 : 3.0), -3.0), QString::number(n + 1));
  }
}

void draw_unfinished(QPainter& painter, const PictureMap& map, std::span<const ultrasound::Vec2> marks_T,
                     const ultrasound::Vec2& hover_T, bool is_ellipse, bool is_angle, const QString& result) {
  painter.setBrush(Qt::NoBrush);
  painter.setFont(caption_font(false));
  painter.setPen(QPen(kCaliperInk, 1.2));
  const QPen line = dotted_pen(kCaliperInk, 1.2);
  const QPointF hover = map.to_view(hover_T);
  for (const ultrasound::Vec2& mark_T : marks_T) draw_cross(painter, map.to_view(mark_T), kCross_px);
  draw_cross(painter, hover, kCross_px);
  if (marks_T.empty()) return;
  if (!result.isEmpty()) draw_result(painter, map, hover, result);
  if (is_ellipse && marks_T.size() == 2) {
    ultrasound::EllipseCaliper ellipse{marks_T[0], marks_T[1], 0.0};
    ellipse.half_width_mm = ellipse.distance_to_axis_mm(hover_T);
    draw_outline(painter, map, ellipse, line);
    return;
  }
  if (is_angle && marks_T.size() == 2)
    draw_caliper_line(painter, map.to_view(marks_T[0]), map.to_view(marks_T[1]), line);
  draw_caliper_line(painter, is_angle ? map.to_view(marks_T[0]) : map.to_view(marks_T.back()), hover, line);
}

}  // namespace trocar::trainer
