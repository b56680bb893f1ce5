#pragma once

#include <QFont>
#include <QPen>
#include <QSizeF>
#include <QString>
#include <QStringList>
#include <optional>
#include <span>
#include <vector>

#include "ultrasound/live/live_scanner.h"
#include "ultrasound/probe/transducer.h"
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

/// Data for the caption of an image. A small view has a shorter caption.
struct CaptionFacts {
  QString transducer;
  double frames_per_s = 0.0;
  ultrasound::CineState cine;
  std::span<const ultrasound::Measurement> measurements;
  bool is_small = false;
  std::optional<ultrasound::AcousticOutput> output = {};  ///< For MI and TIS (small: MI); empty: none.
  double zoom = 1.0;                                      ///< Displayed if above 1.
};
std::vector<CaptionLine> caption_of(const ultrasound::ScanPicture& picture, const CaptionFacts& facts);
QFont caption_font(bool is_small);
QSizeF caption_size(const std::vector<CaptionLine>& lines, const QFont& font);
/// Size of the gray wedge and the colour bar beside it.
QSizeF bars_size(const QFont& font, double view_height, bool has_doppler);

/// Draws a message on a dark background at the top of the image.
void draw_message(QPainter& painter, const QRectF& picture, const QString& text, const QFont& font);
/// `is_on_image`: dims the image behind the lines.
void draw_caption(QPainter& painter, const QRectF& place, const std::vector<CaptionLine>& lines, const QFont& font,
                  bool is_on_image = false);
/// Radius of the orientation marker.
inline constexpr double kMarker_px = 4.0;
/// Centre of the orientation marker: beside the marked end of the face, within the space that the layout reserves
/// around the image.
QPointF marker_place(const PictureMap& map, const ultrasound::ScanAnnotation& annotation);
/// Depth ticks and numbers, focus, orientation marker.
void draw_depth_scale(QPainter& painter, const PictureMap& map, double scale_x,
                      const ultrasound::ScanAnnotation& annotation, const QFont& font);
void draw_bars(QPainter& painter, const QRectF& place, const ultrasound::ScanAnnotation& annotation,
               const ultrasound::ScanPicture& picture, const QFont& font);

/// A cross about `at`; `size`: length of each arm in points.
void draw_cross(QPainter& painter, const QPointF& at, double size);
QPen dotted_pen(const QColor& color, double width);
/// Draws calipers with their numbers, and rings about the marks of the selected one. draw_unfinished draws an
/// unfinished measurement with `marks_T`, whose next mark is at hover_T, and its present result there.
void draw_measurements(QPainter& painter, const PictureMap& map, std::span<const ultrasound::Measurement> measurements,
                       std::optional<std::size_t> chosen);
void draw_unfinished(QPainter& painter, const PictureMap& map, std::span<const ultrasound::Vec2> marks_T,
                     const ultrasound::Vec2& hover_T, bool is_ellipse, bool is_angle, const QString& result);

}  // namespace trocar::trainer
