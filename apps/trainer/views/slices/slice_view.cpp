#include "views/slices/slice_view.h"

#include <QPainter>
#include <algorithm>
#include <cmath>

#include "ui_kit/theme.h"
#include "ui_kit/window_language.h"
#include "views/slices/slice_canvas.h"
#include "views/view_strip.h"

namespace trocar::trainer {
namespace {

constexpr double kNeedleField_mm = 180.0;  ///< Initial field of view of a needle's plane.
constexpr double kFitMargin = 1.04;        ///< Margin of the picture around the body.
constexpr double kMiddlePart = 0.3;        ///< Share of each side of the centre that the anchor may use.

struct KindInfo {
  const char* object_name;
  const char* title;
  QColor color;
  CrossColors cross;
};

KindInfo info_of(SliceKind kind) {
  const Theme& t = theme();
  switch (kind) {
    case SliceKind::kAxial:
      return {"slice-axial", QT_TRANSLATE_NOOP("Table", "Axial"), t.axial, {t.sagittal, t.coronal}};
    case SliceKind::kCoronal:
      return {"slice-coronal", QT_TRANSLATE_NOOP("Table", "Coronal"), t.coronal, {t.sagittal, t.axial}};
    case SliceKind::kSagittal:
      return {"slice-sagittal", QT_TRANSLATE_NOOP("Table", "Sagittal"), t.sagittal, {t.coronal, t.axial}};
    case SliceKind::kAlongNeedle:
      return {"slice-along-needle",
              QT_TRANSLATE_NOOP("Table", "Along needle"),
              t.along_needle,
              {t.turned_needle, t.across_needle}};
    case SliceKind::kAlongNeedleTurned:
      return {"slice-along-turned",
              QT_TRANSLATE_NOOP("Table", "Along, turned"),
              t.turned_needle,
              {t.along_needle, t.across_needle}};
    case SliceKind::kAcrossNeedle:
      return {"slice-across-needle",
              QT_TRANSLATE_NOOP("Table", "Across needle"),
              t.across_needle,
              {t.turned_needle, t.along_needle}};
    case SliceKind::kLateral:
      return {"us-lateral",
              QT_TRANSLATE_NOOP("Table", "Ultrasound, lateral"),
              t.along_needle,
              {t.turned_needle, t.across_needle}};
    case SliceKind::kElevation:
      return {"us-elevation",
              QT_TRANSLATE_NOOP("Table", "Ultrasound, elevation"),
              t.turned_needle,
              {t.along_needle, t.across_needle}};
    case SliceKind::kAcrossBeams:
      break;
  }
  return {"us-across-beams",
          QT_TRANSLATE_NOOP("Table", "Ultrasound, C-plane"),
          t.across_needle,
          {t.turned_needle, t.along_needle}};
}

slices::SliceAxes axes_of(SliceKind kind, const Vec3& needle_P, const Mat3& R_UB) {
  switch (kind) {
    case SliceKind::kAxial:
      return slices::slice_axes(slices::SliceOrientation::kAxial);
    case SliceKind::kCoronal:
      return slices::slice_axes(slices::SliceOrientation::kCoronal);
    case SliceKind::kSagittal:
      return slices::slice_axes(slices::SliceOrientation::kSagittal);
    case SliceKind::kAlongNeedle:
      return slices::needle_axes(needle_P, slices::NeedlePlane::kAlong);
    case SliceKind::kAlongNeedleTurned:
      return slices::needle_axes(needle_P, slices::NeedlePlane::kAlongTurned);
    case SliceKind::kAcrossNeedle:
      return slices::needle_axes(needle_P, slices::NeedlePlane::kAcross);
    case SliceKind::kLateral:
      return {R_UB.col(0), R_UB.col(1)};
    case SliceKind::kElevation:
      return {R_UB.col(2), R_UB.col(1)};
    case SliceKind::kAcrossBeams:
      break;
  }
  return {R_UB.col(0), R_UB.col(2)};
}

const char* const kHelp = QT_TRANSLATE_NOOP(
    "Table",
    "Left drag: move the cross-hairs (arrow keys) · wheel: scroll (Page Up, Page Down) · Ctrl + wheel: zoom (+, −)\n"
    "Right drag: window (1–5: presets) · middle or Shift + left drag: pan · double click: centre\n"
    "R: reset · L: labels on and off");
const char* const kUltrasoundHelp = QT_TRANSLATE_NOOP(
    "Table",
    "Left drag: move the cross-hairs (arrow keys) · wheel: scroll (Page Up, Page Down) · Ctrl + wheel: zoom (+, −)\n"
    "Right drag: brightness and contrast · middle or Shift + left drag: pan · double click: centre · R: reset");

}  // namespace

SliceView::SliceView(SliceKind kind, QWidget* parent)
    : QWidget(parent),
      kind_(kind),
      strip_(new ViewStrip(*this, [this](QPainter& painter, const QRectF& room) { paint_strip(painter, room); })) {
  const KindInfo info = info_of(kind);
  setObjectName(QString::fromLatin1(info.object_name));
  setAccessibleName(tr("%1 slice").arg(tr(info.title)));
  setToolTip(tr(is_ultrasound() ? kUltrasoundHelp : kHelp));
  style_.window = first_window();
  strip_->setToolTip(toolTip());
  setFocusPolicy(Qt::StrongFocus);
  setAttribute(Qt::WA_OpaquePaintEvent);
  setCursor(Qt::CrossCursor);
  X_PN_ = needle_pose(Vec3::Zero(), Vec3::UnitY());
  update_axes();
  update_size();
}

SliceView::~SliceView() = default;

slices::Window SliceView::first_window() const {
  return is_ultrasound() ? slices::Window{127.5, 255.0} : slices::Window{};
}

void SliceView::set_beam_frame(const Mat3& R_UB) {
  R_UB_ = R_UB;
  update_axes();
  move_plane_to_anchor();
  update();
}

void SliceView::set_overlay(Overlay overlay) {
  overlay_ = std::move(overlay);
  is_stale_ = true;
  update();
}

void SliceView::show_patient(std::shared_ptr<const anatomy::VirtualPatient> patient) {
  const slices::Box body_P = patient ? slices::body_box(*patient) : slices::Box();
  show_patient(std::move(patient), body_P);
}

void SliceView::show_patient(std::shared_ptr<const anatomy::VirtualPatient> patient, const slices::Box& body_P) {
  patient_ = std::move(patient);
  is_stale_ = true;
  if (patient_) {
    body_P_ = body_P;
    focus_P_ = body_P_.center();
    fit();
  }
  update();
}

void SliceView::set_focus(const Vec3& p_P) {
  if (!p_P.allFinite() || p_P == focus_P_) return;
  focus_P_ = p_P;
  if (!follows_needle()) {
    move_plane_to_anchor();
    follow_anchor();
  }
  update();
}

void SliceView::set_needle(std::span<const Vec3> shaft_P) {
  if (std::equal(shaft_P.begin(), shaft_P.end(), shaft_P_.begin(), shaft_P_.end())) return;
  shaft_P_.assign(shaft_P.begin(), shaft_P.end());
  update();
}

void SliceView::set_needle_frame(const Pose& X_PN) {
  if (!X_PN.is_finite() || (X_PN.p() == X_PN_.p() && X_PN.R() == X_PN_.R())) return;
  X_PN_ = X_PN;
  if (!follows_needle()) return;
  update_axes();
  move_plane_to_anchor();
  follow_anchor();
  update();
}

void SliceView::set_paths(const std::optional<Segment>& path_P, std::vector<Segment> others_P) {
  path_A_ = path_P;
  other_paths_P_ = std::move(others_P);
  update();
}

void SliceView::set_entry_zone(const std::optional<tasks::EntryZone>& zone) {
  const bool is_same = zone.has_value() == zone_.has_value() &&
                       (!zone || (zone->centre_P == zone_->centre_P && zone->radius_mm == zone_->radius_mm));
  if (is_same) return;
  zone_ = zone;
  update();
}

void SliceView::set_guidance(scene::Guidance guidance) {
  if (std::exchange(guidance_, guidance) == guidance) return;
  is_stale_ = true;  // visibility of lesions can change
  update();
}

void SliceView::set_window(double centre_hu, double width_hu) {
  if (!std::isfinite(centre_hu) || !std::isfinite(width_hu)) return;
  const slices::Window window{centre_hu, std::max(width_hu, 1.0)};
  if (style_.window == window) return;
  style_.window = window;
  is_stale_ = true;
  update();
}

void SliceView::set_label_opacity(double opacity) {
  const double share = std::clamp(opacity, 0.0, 1.0);
  if (style_.label_opacity == share) return;
  style_.label_opacity = share;
  is_stale_ = true;
  update();
}

void SliceView::set_labels_visible(bool is_visible) {
  if (std::exchange(has_labels_, is_visible) == is_visible) return;
  is_stale_ = true;
  update();
}

void SliceView::reset() {
  offset_mm_ = 0.0;
  fit();
  change_window(first_window());
}

QRectF SliceView::picture_rect() const {
  const double top = strip_->height_in_view();
  return {0.0, top, static_cast<double>(width()), std::max(1.0, height() - top)};
}

Eigen::Vector2d SliceView::to_pixel(const QPointF& position) const {
  const QPointF in_picture = device_pixel_ratio_ * (position - picture_rect().topLeft());
  return {in_picture.x() - 0.5, in_picture.y() - 0.5};
}

Vec3 SliceView::point_at(const QPointF& position) const {
  return geometry_.to_P(to_pixel(position));
}

QPointF SliceView::position_of(const Vec3& p_P) const {
  const Eigen::Vector2d pixel = geometry_.to_pixel(p_P);
  return picture_rect().topLeft() + QPointF(pixel.x() + 0.5, pixel.y() + 0.5) / device_pixel_ratio_;
}

Vec3 SliceView::anchor_P() const {
  return follows_needle() ? Vec3(X_PN_.p() + offset_mm_ * geometry_.axes.normal_P()) : focus_P_;
}

void SliceView::update_axes() {
  geometry_.axes = axes_of(kind_, X_PN_.R().col(2), R_UB_);
  is_stale_ = true;
}

void SliceView::move_plane_to_anchor() {
  const double height_mm = geometry_.height_mm(anchor_P());
  if (height_mm == 0.0) return;
  geometry_.center_P += height_mm * geometry_.axes.normal_P();
  is_stale_ = true;
}

void SliceView::follow_anchor() {
  const Eigen::Vector2d size(geometry_.columns, geometry_.rows);
  const Eigen::Vector2d from_middle = geometry_.to_pixel(anchor_P()) - 0.5 * (size - Eigen::Vector2d::Ones());
  const Eigen::Vector2d room = kMiddlePart * size;
  const Eigen::Vector2d beyond = from_middle - from_middle.cwiseMax(-room).cwiseMin(room);
  if (beyond.isZero()) return;
  geometry_.center_P += geometry_.mm_per_px * (beyond.x() * geometry_.axes.u_P + beyond.y() * geometry_.axes.v_P);
  is_stale_ = true;
}

void SliceView::update_size() {
  const QSizeF size = picture_rect().size();
  const double ratio = devicePixelRatioF();
  const int columns = std::max(1, static_cast<int>(std::lround(size.width() * ratio)));
  const int rows = std::max(1, static_cast<int>(std::lround(size.height() * ratio)));
  if (columns == geometry_.columns && rows == geometry_.rows && ratio == device_pixel_ratio_) return;
  geometry_.mm_per_px *= device_pixel_ratio_ / ratio;
  device_pixel_ratio_ = ratio;
  geometry_.columns = columns;
  geometry_.rows = rows;
  is_stale_ = true;
  if (is_fitted_) fit();
}

void SliceView::fit() {
  is_fitted_ = true;
  is_stale_ = true;
  if (!body_P_.isEmpty()) {
    geometry_.mm_per_px = kFitMargin * fitting_scale(body_P_, geometry_.axes, geometry_.columns, geometry_.rows);
    geometry_.center_P = body_P_.center();
  }
  if (follows_needle()) {
    geometry_.mm_per_px = kNeedleField_mm / std::min(geometry_.columns, geometry_.rows);
    geometry_.center_P = anchor_P();
  }
  move_plane_to_anchor();
  update();
}

void SliceView::set_motion(const motion::PatientMotion& motion) {
  if (motion.is_same_place(motion_)) return;
  motion_ = motion;
  is_stale_ = true;
  update();
}

void SliceView::redraw_picture() {
  if (!is_stale_ || !patient_) return;
  slices::SliceStyle style = style_;
  style.hides_lesions = guidance_ == scene::Guidance::kNone;
  if (!has_labels_) {
    style.label_opacity = 0.0;
    style.has_outlines = false;
  }
  slices::paint_slice(*patient_, geometry_.plane(), style, buffers_, picture_, motion_);
  if (overlay_) overlay_(geometry_.plane(), picture_);
  is_stale_ = false;
}

void SliceView::paintEvent(QPaintEvent* /*event*/) {
  update_size();
  redraw_picture();
  QPainter painter(this);
  const QRectF area = picture_rect();
  painter.fillRect(area, theme().view);
  if (patient_) {
    const QImage image(reinterpret_cast<const uchar*>(picture_.pixels.data()), picture_.columns, picture_.rows,
                       3 * picture_.columns, QImage::Format_RGB888);
    painter.drawImage(area, image);
    paint_overlay(painter);
  } else {
    painter.setPen(theme().dim);
    painter.setFont(scaled_font(1.0));
    painter.drawText(area, Qt::AlignCenter, is_ultrasound() ? tr("No ultrasound") : tr("No patient"));
  }
  strip_->refresh(place_text() + window_text() + (hasFocus() ? QLatin1String("*") : QLatin1String()) +
                  (has_labels_ ? QLatin1String() : QLatin1String("-")));
}

void SliceView::draw_plan(const SliceCanvas& canvas) const {
  if (guidance_ == scene::Guidance::kNone) return;
  if (zone_) draw_entry_zone(canvas, *zone_);
  if (guidance_ == scene::Guidance::kPath)
    for (const Segment& other_P : other_paths_P_) draw_other_path(canvas, other_P);
  if (path_A_) {
    const Segment now_P{motion_.to_now(path_A_->a), motion_.to_now(path_A_->b)};
    if (guidance_ == scene::Guidance::kPath) draw_path(canvas, now_P);
    draw_target(canvas, now_P.b);
  }
  const bool is_along = kind_ == SliceKind::kAlongNeedle || kind_ == SliceKind::kAlongNeedleTurned;
  if (guidance_ == scene::Guidance::kPath && is_along) draw_aim(canvas, shaft_P_);
}

void SliceView::paint_overlay(QPainter& painter) const {
  painter.save();
  painter.setClipRect(picture_rect());
  painter.setRenderHint(QPainter::Antialiasing);
  const SliceCanvas canvas{painter, geometry_, picture_rect(), device_pixel_ratio_};
  draw_crosshair(canvas, anchor_P(), info_of(kind_).cross, follows_needle());
  draw_plan(canvas);
  draw_needle(canvas, shaft_P_);
  if (!is_ultrasound()) draw_letters(canvas);
  draw_scale_bar(canvas);
  painter.restore();
}

void SliceView::set_frame_at_skin(bool is_at_skin) {
  is_frame_at_skin_ = is_at_skin;
  update();
}

QString SliceView::place_text() const {
  // Direction letters of P: the LPS axes point to the left, to the back and to the head.
  const auto beyond = [](double mm, const char* positive, const char* negative) {
    const double shown_mm = std::abs(mm) < 0.05 ? 0.0 : std::abs(mm);
    return QStringLiteral("%L1 %L2 mm").arg(QString::fromUtf8(mm < 0.0 ? negative : positive)).arg(shown_mm, 0, 'f', 1);
  };
  switch (kind_) {
    case SliceKind::kAxial:
      return beyond(focus_P_.z(), "H", "F");
    case SliceKind::kCoronal:
      return beyond(focus_P_.y(), "P", "A");
    case SliceKind::kSagittal:
      return beyond(focus_P_.x(), "L", "R");
    case SliceKind::kLateral:
    case SliceKind::kElevation:
    case SliceKind::kAcrossBeams:
      return beyond((focus_P_ - body_P_.center()).dot(geometry_.axes.normal_P()), "+", "−");
    default:
      if (offset_mm_ == 0.0) return is_frame_at_skin_ ? tr("at the skin") : tr("at the tip");
      return beyond(offset_mm_, "+", "−");
  }
}

QString SliceView::window_text() const {
  const slices::Window& window = style_.window;
  return QStringLiteral("W %1 L %2").arg(std::lround(window.width_hu)).arg(std::lround(window.center_hu));
}

void SliceView::paint_strip(QPainter& painter, QRectF room) const {
  constexpr double kMargin = 8.0;
  const Theme& t = theme();
  const KindInfo info = info_of(kind_);
  constexpr double kLine = 2.0;
  const QRectF strip = strip_->rect();
  painter.fillRect(strip, t.panel);
  painter.fillRect(strip.adjusted(0.0, strip.height() - kLine, 0.0, 0.0),
                   hasFocus() ? info.color : info.color.darker(220));
  room.adjust(0.0, 0.0, 0.0, -kLine);

  bool has_room = true;  // texts without space are omitted, together with all of lower priority
  const auto put = [&](const QString& text, double size, bool is_bold, const QColor& color, bool is_right) {
    painter.setFont(scaled_font(size, is_bold));
    const double wide = std::ceil(QFontMetricsF(painter.font()).horizontalAdvance(text));
    has_room = has_room && wide <= room.width();
    if (!has_room) return;
    painter.setPen(color);
    painter.drawText(room, static_cast<int>(Qt::AlignVCenter | (is_right ? Qt::AlignRight : Qt::AlignLeft)), text);
    is_right ? room.setRight(room.right() - wide - kMargin) : room.setLeft(room.left() + wide + kMargin);
  };
  put(tr(info.title), 0.95, true, info.color, false);
  put(place_text(), 0.9, false, t.text, false);
  put(window_text(), 0.85, false, t.dim, true);
  if (!has_labels_) put(tr("no labels"), 0.85, false, t.warning, true);
  if (!is_ultrasound()) put(shown(slices::window_name(style_.window)), 0.85, false, t.dim, true);
}

QSize SliceView::sizeHint() const {
  return {400, 360};
}

QSize SliceView::minimumSizeHint() const {
  return {200, 150};
}

}  // namespace trocar::trainer
