#pragma once

#include <QFont>
#include <QSizeF>
#include <QString>
#include <QStringList>
#include <optional>
#include <span>
#include <vector>

#include "ultrasound/live/live_scanner.h"
#include "ultrasound/scanner/measurements.h"
#include "ultrasound/scanner/scan_annotation.h"
#include "views/ultrasound/ultrasound_layout.h"

class QPainter;

namespace trocar::trainer {

/// A line of the caption.
struct CaptionLine {
  enum class Kind { kPlain, kName, kWarning, kResult, kFrozen };
  QString text;
  Kind kind = Kind::kPlain;
};

/// What is said beside a picture. A small view says less.
struct CaptionFacts {
  QString transducer;
  double frames_per_s = 0.0;
  ultrasound::CineState cine;
  std::span<const ultrasound::Measurement> measurements;
  bool is_small = false;
};
std::vector<CaptionLine> caption_of(const ultrasound::ScanPicture& picture, const CaptionFacts& facts);
QFont caption_font(bool is_small);
QSizeF caption_size(const std::vector<CaptionLine>& lines, const QFont& font);
/// Of the gray wedge, and the colour bar beside it.
QSizeF bars_size(const QFont& font, double view_height, bool has_doppler);

/// On a dark ground at the top of the picture.
void draw_message(QPainter& painter, const QRectF& picture, const QString& text, const QFont& font);
void draw_caption(QPainter& painter, const QRectF& place, const std::vector<CaptionLine>& lines, const QFont& font);
/// Radius of the orientation marker.
inline constexpr double kMarker_px = 4.0;
/// Middle of the orientation marker: beside the face's marked end, and never farther from the picture than the layout
/// has room for.
QPointF marker_place(const PictureMap& map, const ultrasound::ScanAnnotation& annotation);
/// Depth ticks and numbers, focus, orientation marker.
void draw_depth_scale(QPainter& painter, const PictureMap& map, double scale_x,
                      const ultrasound::ScanAnnotation& annotation, const QFont& font);
void draw_bars(QPainter& painter, const QRectF& place, const ultrasound::ScanAnnotation& annotation,
               const ultrasound::ScanPicture& picture, const QFont& font);

/// Calipers with their numbers, rings about the marks of the chosen one; `marks_T` of one in the making, whose next
/// mark is at hover_T.
void draw_measurements(QPainter& painter, const PictureMap& map, std::span<const ultrasound::Measurement> measurements,
                       std::optional<std::size_t> chosen);
void draw_unfinished(QPainter& painter, const PictureMap& map, std::span<const ultrasound::Vec2> marks_T,
                     const ultrasound::Vec2& hover_T, bool is_ellipse, bool is_angle);

/// Dots along a line in the picture, a longer one each centimetre.
void draw_guide(QPainter& painter, const PictureMap& map, std::span<const ultrasound::Vec2> line_T);
/// Where the axis of a needle lies within `near_mm` of the plane (dotted), and where it pierces it (cross).
void draw_needle_axis(QPainter& painter, const PictureMap& map, const ultrasound::ScanPicture& picture,
                      std::span<const Vec3> shaft_P);

}  // namespace trocar::trainer
