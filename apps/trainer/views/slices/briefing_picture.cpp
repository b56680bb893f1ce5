#include "views/slices/briefing_picture.h"

#include <QCoreApplication>
#include <QFontMetricsF>
#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <array>

#include "anatomy/structure_words.h"
#include "slices/paint_slice.h"
#include "slices/slice_geometry.h"
#include "ui_kit/theme.h"
#include "ui_kit/window_language.h"
#include "views/slices/slice_canvas.h"

namespace trocar::trainer {
namespace {

constexpr double kAroundPath_mm = 60.0;

/// Centre of the target: a biopsy needle stops short of it.
Vec3 target_of(const cases::Case& the_case) {
  const Segment& path_P = the_case.plan.line_P;
  return path_P.b + the_case.needle.notch_middle_mm() * path_P.direction();
}

slices::SliceGeometry geometry_of(const cases::OpenCase& open, BriefingPlane plane, const QSize& size) {
  const anatomy::VirtualPatient& patient = *open.the_case.patient;
  const Segment& path_P = open.the_case.plan.line_P;
  slices::SliceGeometry geometry;
  geometry.columns = size.width();
  geometry.rows = size.height();
  if (plane != BriefingPlane::kAlongPath) {
    const slices::Box body = slices::body_box(patient);
    const bool is_axial = plane == BriefingPlane::kAxial;
    geometry.axes =
        slices::slice_axes(is_axial ? slices::SliceOrientation::kAxial : slices::SliceOrientation::kSagittal);
    geometry.center_P = body.center();
    const Vec3 across_P = geometry.axes.normal_P();
    geometry.center_P += (target_of(open.the_case) - geometry.center_P).dot(across_P) * across_P;
    geometry.mm_per_px = slices::fitting_scale(body, geometry.axes, geometry.columns, geometry.rows);
  } else {
    geometry.axes = slices::needle_axes(path_P.direction(), slices::NeedlePlane::kAlong);
    geometry.center_P = 0.5 * (path_P.a + path_P.b);
    geometry.mm_per_px = (path_P.length_mm() + kAroundPath_mm) / std::min(geometry.columns, geometry.rows);
  }
  return geometry;
}

void draw_planned_path(QPainter& painter, const slices::SliceGeometry& geometry, const cases::Case& the_case,
                       scene::Guidance guidance) {
  const Segment& path_P = the_case.plan.line_P;
  const auto pixel = [&](const Vec3& p_P) {
    const Eigen::Vector2d p = geometry.to_pixel(p_P);
    return QPointF(p.x() + 0.5, p.y() + 0.5);
  };
  const QPointF tip = pixel(path_P.b);
  constexpr double kRing_px = 7.0, kEntry_px = 5.0;
  painter.setPen(QPen(theme().path, 2.0));
  if (guidance != scene::Guidance::kNone) painter.drawEllipse(pixel(path_P.a), kEntry_px, kEntry_px);
  painter.setPen(QPen(theme().path, 2.0, Qt::DashLine));
  if (guidance == scene::Guidance::kPath) painter.drawLine(pixel(path_P.a), tip);
  painter.setPen(QPen(theme().target, 2.0));
  painter.drawEllipse(guidance == scene::Guidance::kPath ? tip : pixel(target_of(the_case)), kRing_px, kRing_px);
}

QString title_of(BriefingPlane plane) {
  switch (plane) {
    case BriefingPlane::kAxial:
      return QCoreApplication::translate("BriefingPicture", "Axial");
    case BriefingPlane::kSagittal:
      return QCoreApplication::translate("BriefingPicture", "Sagittal");
    case BriefingPlane::kAlongPath:
      return QCoreApplication::translate("BriefingPicture", "Along the planned path");
  }
  return {};
}

/// Samples of each label id in a slice, every fourth pixel; a hidden lesion counts as its organ.
std::array<std::size_t, 256> count_labels(const cases::OpenCase& open, BriefingPlane plane, const QSize& size,
                                          bool hides_lesions) {
  constexpr int kStep_px = 4;
  const anatomy::VirtualPatient& patient = *open.the_case.patient;
  const slices::SliceGeometry geometry = geometry_of(open, plane, size);
  const std::array<std::uint8_t, 256> shown = anatomy::lesions_as_organs(patient.label_table);
  std::array<std::size_t, 256> counts{};
  for (int row = 0; row < geometry.rows; row += kStep_px)
    for (int column = 0; column < geometry.columns; column += kStep_px) {
      const anatomy::Label* label = find_label(patient, geometry.to_P({column, row}));
      const std::uint8_t id = label != nullptr ? label->id : std::uint8_t{0};
      ++counts[hides_lesions ? shown[id] : id];
    }
  return counts;
}

}  // namespace

QImage to_qimage(const image::RgbImage& picture) {
  static_assert(sizeof(image::Rgb) == 3);
  return QImage(reinterpret_cast<const uchar*>(picture.pixels.data()), picture.columns, picture.rows,
                3 * picture.columns, QImage::Format_RGB888)
      .copy();
}

QImage briefing_picture(const cases::OpenCase& open, BriefingPlane plane, const QSize& size, scene::Guidance guidance) {
  const slices::SliceGeometry geometry = geometry_of(open, plane, size);
  slices::SliceBuffers buffers;
  image::RgbImage picture;
  slices::SliceStyle style;
  style.window = {60.0, 350.0};
  style.hides_lesions = guidance == scene::Guidance::kNone;
  slices::paint_slice(*open.the_case.patient, geometry.plane(), style, buffers, picture);
  QImage image = to_qimage(picture).convertToFormat(QImage::Format_RGB32);
  QPainter painter(&image);
  painter.setRenderHint(QPainter::Antialiasing);
  draw_planned_path(painter, geometry, open.the_case, guidance);
  const SliceCanvas canvas{painter, geometry, QRectF(image.rect())};
  draw_letters(canvas);
  draw_scale_bar(canvas);
  painter.setFont(scaled_font(0.9));
  draw_text(painter, {8.0, 6.0 + QFontMetricsF(painter.font()).ascent()}, title_of(plane), theme().dim);
  return image;
}

std::vector<LegendEntry> briefing_legend(const cases::OpenCase& open, BriefingPlane plane, const QSize& size,
                                         scene::Guidance guidance) {
  constexpr double kLeastShare = 0.001;
  const anatomy::VirtualPatient& patient = *open.the_case.patient;
  const std::array<std::size_t, 256> counts = count_labels(open, plane, size, guidance == scene::Guidance::kNone);
  std::size_t samples = 0;
  for (const std::size_t count : counts) samples += count;
  std::vector<LegendEntry> entries;
  for (const anatomy::Label& label : patient.label_table.labels) {
    const double share = static_cast<double>(counts[label.id]) / static_cast<double>(std::max<std::size_t>(1, samples));
    if (!slices::is_drawn(label) || share < kLeastShare) continue;
    const QColor color(label.color[0], label.color[1], label.color[2]);
    const auto same =
        std::find_if(entries.begin(), entries.end(), [&](const LegendEntry& entry) { return entry.color == color; });
    const QString name = shown(anatomy::structure_words(label.name));
    if (same == entries.end()) {
      entries.push_back({color, name, share, tasks::is_target(open.the_case.task, label), name, share});
    } else {
      if (share > same->largest_share) {
        same->largest = name;
        same->largest_share = share;
      }
      same->words = shown(anatomy::structure_words(label.tissue));
      same->share += share;
      same->is_target |= tasks::is_target(open.the_case.task, label);
    }
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const LegendEntry& a, const LegendEntry& b) { return a.share > b.share; });
  return entries;
}

void tell_apart(std::vector<LegendEntry>& entries) {
  QStringList words;
  for (const LegendEntry& entry : entries) words << entry.words;
  for (LegendEntry& entry : entries)
    if (words.count(entry.words) > 1 && entry.words != entry.largest)
      entry.words = QCoreApplication::translate("BriefingPicture", "%1 and others").arg(entry.largest);
}

}  // namespace trocar::trainer
