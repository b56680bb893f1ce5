// Keys and mouse of the ultrasound view.
#include <QKeyEvent>
#include <QMouseEvent>
#include <QShortcut>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>
#include <utility>

#include "ui_kit/action_table.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"
#include "ultrasound/scanner/display_settings.h"
#include "views/ultrasound/ultrasound_view.h"

namespace trocar::trainer {
namespace {

constexpr double kGainStep_db = 2.0;
constexpr double kDepthStep_mm = 10.0;
/// Distance in points from which a press is a drag that draws a line instead of setting a mark.
constexpr double kDrag_px = 6.0;

std::size_t marks_of(MeasuringTool tool) noexcept {
  return tool == MeasuringTool::kDistance ? 2 : 3;
}

double turned(const QWheelEvent& event) noexcept {
  constexpr double kNotch = 120.0;
  return event.angleDelta().y() / kNotch;
}

/// The third mark of an ellipse is next to its axis.
ultrasound::Measurement finished(MeasuringTool tool, const std::vector<ultrasound::Vec2>& m) {
  if (tool == MeasuringTool::kDistance) return ultrasound::DistanceCaliper{m[0], m[1]};
  if (tool == MeasuringTool::kAngle) return ultrasound::AngleCaliper{m[0], m[1], m[2]};
  ultrasound::EllipseCaliper ellipse{m[0], m[1], 0.0};
  ellipse.half_width_mm = ellipse.distance_to_axis_mm(m[2]);
  return ellipse;
}

}  // namespace

void UltrasoundView::set_harmonic(bool is_on) {
  if (!has_harmonic() || is_on == settings_.acquisition.is_harmonic) return;
  change_settings([&](UltrasoundSettings& s) {
    s.acquisition.is_harmonic = is_on;
    s.acquisition.frequency_mhz = transducer_.frequency_mhz;
  });
}

bool UltrasoundView::has_harmonic() const noexcept {
  return ultrasound::harmonic_mhz(transducer_, transducer_.frequency_mhz).has_value();
}

void UltrasoundView::set_gain_automatically() {
  change_settings([](UltrasoundSettings& s) { s.is_gain_automatic = true; });
  is_gain_wanted_ = true;
}

void UltrasoundView::set_gain(double gain_db) {
  is_gain_wanted_ = false;
  change_settings([=](UltrasoundSettings& s) {
    s.is_gain_automatic = false;
    s.display.gain_db = gain_db;
  });
}

/// By a live image of tissue: the transducer may still be in the air.
void UltrasoundView::adjust_gain() {
  constexpr double kCoupled = 0.5;
  if (!is_gain_wanted_ || !settings_.is_gain_automatic || !picture_ || picture_->is_frozen) return;
  if (picture_->coupled_share < kCoupled) return;
  const auto gain_db = ultrasound::automatic_gain_db(picture_->levels, settings_.display);
  if (!gain_db) return;
  is_gain_wanted_ = false;
  change_settings([&](UltrasoundSettings& s) { s.display.gain_db = *gain_db; });
}

void UltrasoundView::make_shortcuts() {
  const auto bind = [this](Action action, auto act) {
    auto* shortcut = new QShortcut(key_of(action), this);
    connect(shortcut, &QShortcut::activated, this, act);
  };
  const auto gain = [this](double by_db) { set_gain(settings_.display.gain_db + by_db); };
  const auto depth = [this](double by_mm) {
    change_settings([=](UltrasoundSettings& s) { s.acquisition.depth_mm += by_mm; });
  };
  bind(Action::kFreeze, [this] { set_frozen(!is_frozen()); });
  bind(Action::kHarmonic, [this] { set_harmonic(!settings_.acquisition.is_harmonic); });
  bind(Action::kAutomaticGain, [this] { set_gain_automatically(); });
  bind(Action::kMoreGain, [=] { gain(kGainStep_db); });
  bind(Action::kLessGain, [=] { gain(-kGainStep_db); });
  bind(Action::kDeeper, [=] { depth(kDepthStep_mm); });
  bind(Action::kShallower, [=] { depth(-kDepthStep_mm); });
  bind(Action::kDoppler, [this] { change_settings([](UltrasoundSettings& s) { s.has_doppler = !s.has_doppler; }); });
  bind(Action::kMeasure, [this] { start_measuring(MeasuringTool::kDistance); });
}

void UltrasoundView::start_measuring(MeasuringTool tool) {
  tool_ = picture_ ? tool : MeasuringTool::kNone;
  marks_T_.clear();
  forget_choice();
  is_pressed_ = false;
  if (tool_ != MeasuringTool::kNone) setFocus();
  setCursor(tool_ != MeasuringTool::kNone ? Qt::CrossCursor : Qt::ArrowCursor);
  update();
  Q_EMIT changed();
}

QString UltrasoundView::live_result() const {
  if (tool_ == MeasuringTool::kNone || marks_T_.empty() || marks_T_.size() + 1 < marks_of(tool_)) return {};
  std::vector<ultrasound::Vec2> marks_T = marks_T_;
  marks_T.push_back(hover_T_);
  return shown(ultrasound::results(finished(tool_, marks_T)).front());
}

void UltrasoundView::leave_tool() {
  // The first Esc removes the marks, the second one leaves the tool.
  if (marks_T_.empty()) {
    start_measuring(MeasuringTool::kNone);
  } else {
    marks_T_.clear();
    update();
  }
}

void UltrasoundView::measurements_changed() {
  update();
  Q_EMIT changed();
}

void UltrasoundView::undo_measurement() {
  measurements_.undo();
  forget_choice();
  measurements_changed();
}

void UltrasoundView::redo_measurement() {
  measurements_.redo();
  forget_choice();
  measurements_changed();
}

void UltrasoundView::remove_measurement() {
  if (chosen_) {
    measurements_.remove(*chosen_);
  } else {
    measurements_.remove_last();
  }
  forget_choice();
  measurements_changed();
}

void UltrasoundView::clear_measurements() {
  measurements_.clear();
  forget_choice();
  measurements_changed();
}

/// Clears the selection, because the indices of measurements have changed or none is selected.
void UltrasoundView::forget_choice() {
  chosen_.reset();
  grip_.reset();
  is_over_mark_ = false;
}

bool UltrasoundView::begin_grip(const QPointF& place) {
  const auto map = picture_map();
  const auto found = map ? find_mark(*map, measurements_.items(), place) : std::nullopt;
  if (!found) {
    if (std::exchange(chosen_, std::nullopt)) measurements_changed();
    return false;
  }
  const ultrasound::Vec2 mark_T = ultrasound::marks_T(measurements_.items()[found->item])[found->mark];
  grip_ = Grip{*found, mark_T - map->to_T(place), false};
  chosen_ = found->item;
  setFocus();
  measurements_changed();
  return true;
}

void UltrasoundView::move_grip(const ultrasound::Vec2& to_T) {
  const ultrasound::Measurement& held = measurements_.items()[grip_->mark.item];
  measurements_.put(grip_->mark.item, ultrasound::with_mark(held, grip_->mark.mark, to_T + grip_->beside_T),
                    grip_->has_moved);
  grip_->has_moved = true;
  measurements_changed();
}

void UltrasoundView::set_mark(const ultrasound::Vec2& p_T) {
  marks_T_.push_back(p_T);
  if (marks_T_.size() == marks_of(tool_)) {
    measurements_.add(finished(tool_, marks_T_));
    start_measuring(MeasuringTool::kNone);
  }
  update();
}

bool UltrasoundView::begin_box_drag(const QPointF& place) {
  const auto map = picture_map();
  if (!map || !settings_.has_doppler || picture_->colour.pixels.empty() || picture_->is_frozen) return false;
  const ultrasound::Vec2 at = box_place(picture_->scan, map->to_T(place));
  const auto part = find_box_part(settings_.doppler.box, at);
  if (!part) return false;
  box_drag_ = BoxDrag{*part, settings_.doppler.box, at};
  return true;
}

void UltrasoundView::show_cursor(const QPointF& place) {
  if (tool_ != MeasuringTool::kNone) return;
  Qt::CursorShape shape = Qt::ArrowCursor;
  const auto map = picture_map();
  is_over_mark_ = map && find_mark(*map, measurements_.items(), place);
  if (is_over_mark_) {
    shape = Qt::PointingHandCursor;
  } else if (map && settings_.has_doppler && !picture_->colour.pixels.empty() && !picture_->is_frozen) {
    const auto part = find_box_part(settings_.doppler.box, box_place(picture_->scan, map->to_T(place)));
    if (part == BoxPart::kWhole) shape = Qt::SizeAllCursor;
    if (part == BoxPart::kFirst || part == BoxPart::kLast) shape = Qt::SizeHorCursor;
    if (part == BoxPart::kNear || part == BoxPart::kFar) shape = Qt::SizeVerCursor;
  }
  if (cursor().shape() != shape) setCursor(shape);
}

void UltrasoundView::mousePressEvent(QMouseEvent* event) {
  const auto map = picture_map();
  if (event->button() == Qt::MiddleButton && map && map->is_magnified()) {
    panned_from_ = event->pos();
    return;
  }
  if (event->button() != Qt::LeftButton || !map) {
    event->ignore();
    return;
  }
  if (tool_ != MeasuringTool::kNone) {
    is_pressed_ = true;
    pressed_at_ = event->pos();
    hover_T_ = map->to_T(event->pos());
    set_mark(hover_T_);
    return;
  }
  if (!begin_grip(event->pos()) && !begin_box_drag(event->pos())) event->ignore();
}

void UltrasoundView::mouseMoveEvent(QMouseEvent* event) {
  const auto map = picture_map();
  if (!map) return;
  if (panned_from_) {
    set_zoom(map->moved_by(event->pos() - *panned_from_));
    panned_from_ = event->pos();
    return;
  }
  if (grip_) return move_grip(map->to_T(event->pos()));
  if (box_drag_) {
    const ultrasound::Vec2 by = box_place(picture_->scan, map->to_T(event->pos())) - box_drag_->from;
    change_settings([&](UltrasoundSettings& s) { s.doppler.box = moved_box(box_drag_->begun, box_drag_->part, by); });
    return;
  }
  if (tool_ != MeasuringTool::kNone) {
    hover_T_ = map->to_T(event->pos());
    update();
  }
  show_cursor(event->pos());
}

void UltrasoundView::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() == Qt::MiddleButton) panned_from_.reset();
  if (event->button() != Qt::LeftButton) return;
  box_drag_.reset();
  grip_.reset();
  if (!std::exchange(is_pressed_, false) || tool_ == MeasuringTool::kNone || marks_T_.empty()) return;
  const QPointF moved = event->pos() - pressed_at_;
  const auto map = picture_map();
  if (map && std::hypot(moved.x(), moved.y()) > kDrag_px) set_mark(map->to_T(event->pos()));
}

void UltrasoundView::wheelEvent(QWheelEvent* event) {
  if (event->modifiers() == Qt::ControlModifier && picture_) {
    constexpr double kPerNotch = 1.15;
    return zoom_at(event->position(), zoom_.factor * std::pow(kPerNotch, turned(*event)));
  }
  if (!is_frozen()) {
    event->ignore();
    return;
  }
  const double notches = turned(*event);
  step_cine(notches < 0.0 ? -1 : 1);
}

/// Returns true if the key has a function at present; a rehearsal has no effect.
bool UltrasoundView::handle_key(const QKeyEvent& event, bool is_rehearsal) {
  auto found = find_action(Scope::kUltrasound, event);
  if (!found) found = find_action(Scope::kPanel, event);
  if (!found) return false;
  const auto act = [&](bool is_meant, auto what) {
    if (is_meant && !is_rehearsal) what();
    return is_meant;
  };
  const bool is_minus = event.key() == Qt::Key_Minus;
  switch (found->action) {
    case Action::kUndoHere:
      return act(measurements_.can_undo(), [this] { undo_measurement(); });
    case Action::kRedoHere:
      return act(measurements_.can_redo(), [this] { redo_measurement(); });
    case Action::kLeaveCaliper:
      return act(tool_ != MeasuringTool::kNone, [this] { leave_tool(); });
    case Action::kDeleteCaliper:
      return act(!measurements_.items().empty(), [this] { remove_measurement(); });
    case Action::kCineFrame:
      return act(is_frozen(), [&] { step_cine(found->key == 0 ? -1 : 1); });
    case Action::kZoomUltrasound:
      return act(is_minus ? zoom_.factor > 1.0 : picture_ != nullptr, [&] { zoom_by_steps(is_minus ? -1 : 1); });
    case Action::kWholeUltrasound:
      return act(zoom_.factor > 1.0, [this] { reset_zoom(); });
    case Action::kCinePlay:
      return act(is_frozen(), [this] { play_cine(!cine().is_playing); });
    default:
      return false;
  }
}

void UltrasoundView::keyPressEvent(QKeyEvent* event) {
  if (!handle_key(*event, false)) QWidget::keyPressEvent(event);
}

bool UltrasoundView::event(QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride) {
    if (handle_key(static_cast<QKeyEvent&>(*event), true)) {
      event->accept();
      return true;
    }
  }
  return QWidget::event(event);
}

}  // namespace trocar::trainer
