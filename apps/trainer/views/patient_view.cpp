#include "views/patient_view.h"

#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QVBoxLayout>
#include <QWheelEvent>
#include <cmath>

#include "scene/input_watch.h"
#include "views/gl_view.h"
#include "views/scan_mask.h"

namespace trocar::trainer {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kOrbit_rad_per_view = 3.6;  ///< A drag over the whole height.
constexpr double kZoomPerNotch = 1.15;
constexpr double kZoomPerView = 6.0;  ///< A drag over the whole height.
constexpr double kKeyOrbit_rad = 0.12;
constexpr double kWheelNotch = 120.0;  ///< Of QWheelEvent::angleDelta.
/// The user's hand is asked for at most so often while a picture is drawn.
constexpr std::chrono::milliseconds kWatchEvery{4};

TransducerFace face_of(const ScanGeometry& scan) {
  TransducerFace face;
  face.is_convex = scan.is_fan;
  face.radius_mm = scan.radius_mm;
  const double span = scan.line_step * (scan.lines - 1);
  if (scan.is_fan) {
    face.field_of_view_rad = span;
  } else {
    face.width_mm = span;
  }
  return face;
}

/// Where the pointer of a mouse event is; the same in Qt 5 and Qt 6.
QPointF place_of(const QMouseEvent& event) {
  return QPointF(event.pos());
}

}  // namespace

struct PatientView::Impl {
  vtkNew<vtkGenericOpenGLRenderWindow> window;
  GlView* gl = nullptr;
  std::unique_ptr<PatientScene> scene;
  std::unique_ptr<DetailPolicy> policy;  ///< Made when it is known what draws.
  Detail drawn;                          ///< Of the last whole frame.
  bool has_drawn = false;
  bool are_tools_moving = false;
  bool is_drawing = false;
  QSize drawn_size;
  FrameTimes moving_times;
  FrameTimes still_times;
  int broken_frames = 0;
  InputWatch watch;
  Clock::time_point last_watch{};
  std::function<bool()> interrupt;
  ScanMask scan_mask;
  std::optional<Pose> X_PT;
  ScanGeometry scan;
  Qt::MouseButton drag = Qt::NoButton;
  QPointF last_place;
};

PatientView::PatientView(QWidget* parent) : QWidget(parent), impl_(std::make_unique<Impl>()) {
  impl_->gl = new GlView(this);
  impl_->gl->setRenderWindow(impl_->window.Get());
  impl_->scene = std::make_unique<PatientScene>(*impl_->window);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(impl_->gl);
  impl_->gl->setObjectName(QStringLiteral("patient-view-surface"));
  impl_->gl->setFocusProxy(this);
  impl_->gl->installEventFilter(this);
  impl_->gl->setMouseTracking(false);
  setFocusPolicy(Qt::StrongFocus);
  setObjectName(QStringLiteral("patient-view"));
  setAccessibleName(tr("3D view of the patient"));
  setToolTip(
      tr("Drag: turn · Shift+drag: move · wheel: zoom · 1–6: views · F follow · L along the needle · N side view"));
}

PatientView::~PatientView() {
  impl_->scene.reset();
}

void PatientView::note_motion() {
  if (impl_->policy) impl_->policy->note_motion(Clock::now());
}

void PatientView::show_patient(std::shared_ptr<const VirtualPatient> patient,
                               std::shared_ptr<const std::vector<NamedMesh>> meshes) {
  impl_->scene->show_patient(std::move(patient), std::move(meshes));
}

bool PatientView::is_ready() const {
  return impl_->scene->is_ready();
}

void PatientView::set_path(const std::optional<Segment>& line_P, double entry_radius_mm) {
  impl_->scene->set_path(line_P, entry_radius_mm);
}

void PatientView::set_guidance(Guidance guidance) {
  impl_->scene->set_guidance(guidance);
}

void PatientView::set_guidance_visible(bool is_visible) {
  is_guidance_visible_ = is_visible;
  impl_->scene->set_guidance_visible(is_visible);
}

void PatientView::set_landmarks_visible(bool are_visible) {
  are_landmarks_visible_ = are_visible;
  impl_->scene->set_landmarks_visible(are_visible);
}

void PatientView::set_needle(std::span<const Vec3> shaft_P, double diameter_mm, NeedleModel model) {
  impl_->scene->set_needle(shaft_P, diameter_mm, model);
}

void PatientView::set_hand(const std::optional<Segment>& ghost_P) {
  impl_->scene->set_hand(ghost_P);
}

void PatientView::set_transducer(const std::optional<Pose>& X_PT, const ScanGeometry& scan) {
  impl_->X_PT = X_PT;
  impl_->scan = scan;
  impl_->scene->set_transducer(X_PT, face_of(scan));
}

void PatientView::set_ultrasound(const RgbImage& picture, const std::array<Vec3, 3>& corners_P) {
  if (!impl_->X_PT || picture.pixels.empty()) return impl_->scene->set_ultrasound(picture, {}, corners_P);
  impl_->scene->set_ultrasound(
      picture, impl_->scan_mask.of(picture.columns, picture.rows, corners_P, *impl_->X_PT, impl_->scan), corners_P);
}

void PatientView::hide_ultrasound() {
  impl_->scene->hide_ultrasound();
}

std::vector<StructureInfo> PatientView::structures() const {
  return impl_->scene->structures();
}

void PatientView::set_opacity(std::string_view name, double opacity) {
  impl_->scene->set_opacity(name, opacity);
}

void PatientView::apply_preset(StructurePreset preset) {
  impl_->scene->apply_preset(preset);
}

void PatientView::set_volume_preset(VolumePreset preset) {
  impl_->scene->set_volume_preset(preset);
}

VolumePreset PatientView::volume_preset() const {
  return impl_->scene->volume_preset();
}

void PatientView::set_mpr(const MprOptions& options) {
  impl_->scene->set_mpr(options);
}

MprOptions PatientView::mpr() const {
  return impl_->scene->mpr();
}

void PatientView::set_camera(CameraPreset preset) {
  impl_->scene->set_camera(preset);
}

void PatientView::set_view(const CameraView& view) {
  impl_->scene->set_view(view);
}

const CameraView& PatientView::view() const {
  return impl_->scene->view();
}

void PatientView::set_follow(FollowMode mode) {
  impl_->scene->set_follow(mode);
}

FollowMode PatientView::follow() const {
  return impl_->scene->follow();
}

void PatientView::reset_camera() {
  set_camera(CameraPreset::kRightAnteriorOblique);
}

void PatientView::set_stereo(const StereoOptions& options) {
  impl_->scene->set_stereo(options);
  impl_->gl->set_mirrored(options.is_mirrored_left_right, options.is_mirrored_up_down);
}

const StereoOptions& PatientView::stereo() const {
  return impl_->scene->stereo();
}

bool PatientView::has_quad_buffer() const {
  return impl_->scene->has_quad_buffer();
}

void PatientView::set_tools_moving(bool are_moving) {
  impl_->are_tools_moving = are_moving;
}

void PatientView::set_interrupt(std::function<bool()> wants_break) {
  impl_->interrupt = std::move(wants_break);
}

const FrameTimes& PatientView::moving_frame_times() const noexcept {
  return impl_->moving_times;
}

const FrameTimes& PatientView::still_frame_times() const noexcept {
  return impl_->still_times;
}

void PatientView::clear_frame_times() noexcept {
  impl_->moving_times.clear();
  impl_->still_times.clear();
}

bool PatientView::is_still() const noexcept {
  return impl_->has_drawn && impl_->drawn == DetailPolicy::full();
}

int PatientView::broken_frames() const noexcept {
  return impl_->broken_frames;
}

PatientScene& PatientView::scene() noexcept {
  return *impl_->scene;
}

void PatientView::render(const Detail& detail, bool may_break) {
  Impl& v = *impl_;
  const double ratio = devicePixelRatioF() * detail.resolution;
  const double wanted = detail.resolution < 1.0 ? ratio : 0.0;  // 0: the screen's own
  if (v.gl->customDevicePixelRatio() != wanted) v.gl->setCustomDevicePixelRatio(wanted);
  const auto wants_break = [&v] {
    const auto now = Clock::now();
    if (now - v.last_watch < kWatchEvery) return false;
    v.last_watch = now;
    return v.watch.has_happened() || (v.interrupt && v.interrupt());
  };
  if (may_break) v.watch.start();
  const auto start = Clock::now();
  const bool is_whole = v.scene->render(detail, may_break ? std::function<bool()>(wants_break) : nullptr);
  const auto end = Clock::now();
  const double frame_ms = std::chrono::duration<double, std::milli>(end - start).count();
  if (!v.policy) v.policy = std::make_unique<DetailPolicy>(v.scene->has_gpu());
  if (!is_whole) {
    ++v.broken_frames;
    v.policy->note_motion(end);
    return render(v.policy->next(end), false);
  }
  v.policy->note_frame(detail, frame_ms, end);
  (detail == DetailPolicy::full() ? v.still_times : v.moving_times).add(frame_ms);
  v.drawn = detail;
  v.has_drawn = true;
  v.drawn_size = v.gl->size();
}

void PatientView::draw() {
  Impl& v = *impl_;
  if (v.is_drawing || !isVisible() || !v.gl->isValid()) return;
  v.is_drawing = true;
  const auto now = Clock::now();
  // What draws is only known after a frame: the first one is a cheap one.
  if (!v.policy) {
    render(DetailPolicy::moving(DetailPolicy::kMovingLevels - 1), false);
    note_motion();
  } else {
    v.scene->poll();
    const bool has_changed = v.scene->has_changed() || v.drawn_size != v.gl->size();
    if (has_changed || v.are_tools_moving) v.policy->note_motion(now);
    const Detail detail = v.policy->next(now);
    const bool rises = v.drawn != detail && detail == DetailPolicy::full();
    if (has_changed || rises) render(detail, rises && !v.scene->has_gpu());
  }
  v.is_drawing = false;
}

void PatientView::draw_whole() {
  impl_->scene->finish_loading();
  render(DetailPolicy::full(), false);
}

bool PatientView::eventFilter(QObject* watched, QEvent* event) {
  if (watched != impl_->gl) return QWidget::eventFilter(watched, event);
  switch (event->type()) {
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonRelease:
    case QEvent::MouseButtonDblClick:
    case QEvent::MouseMove:
    case QEvent::Wheel:
      return on_mouse(event);
    case QEvent::KeyPress:
    case QEvent::KeyRelease:
    case QEvent::Enter:
    case QEvent::Leave:
      event->ignore();
      return true;  // VTK's interactor has keys of its own
    default:
      return QWidget::eventFilter(watched, event);
  }
}

bool PatientView::on_mouse(QEvent* event) {
  Impl& v = *impl_;
  if (event->type() == QEvent::Wheel) {
    const double notches = static_cast<QWheelEvent*>(event)->angleDelta().y() / kWheelNotch;
    set_view(zoomed(view(), std::pow(kZoomPerNotch, notches)));
    event->accept();
    return true;
  }
  auto& mouse = *static_cast<QMouseEvent*>(event);
  const QPointF place = v.gl->unmirrored(place_of(mouse));
  const double height = std::max(1, v.gl->height());
  if (event->type() == QEvent::MouseButtonDblClick) {
    const auto p_P = v.scene->pick(place.x() / std::max(1, v.gl->width()), place.y() / height);
    if (p_P) Q_EMIT picked(*p_P);
  } else if (event->type() == QEvent::MouseButtonPress) {
    setFocus(Qt::MouseFocusReason);
    v.drag = mouse.button() == Qt::LeftButton && (mouse.modifiers() & Qt::ShiftModifier) != 0 ? Qt::MiddleButton
                                                                                              : mouse.button();
    v.last_place = place;
  } else if (event->type() == QEvent::MouseButtonRelease) {
    v.drag = Qt::NoButton;
  } else if (v.drag != Qt::NoButton) {
    const QPointF moved = (place - v.last_place) / height;
    v.last_place = place;
    if (v.drag == Qt::LeftButton)
      set_view(orbited(view(), kOrbit_rad_per_view * moved.x(), -kOrbit_rad_per_view * moved.y()));
    if (v.drag == Qt::MiddleButton) set_view(panned(view(), moved.x(), moved.y()));
    if (v.drag == Qt::RightButton) set_view(zoomed(view(), std::pow(kZoomPerView, -moved.y())));
  }
  event->accept();
  return true;
}

void PatientView::keyPressEvent(QKeyEvent* event) {
  const auto turn = [&](double right, double up) { set_view(orbited(view(), right, up)); };
  const auto toggle = [&](FollowMode mode) { set_follow(follow() == mode ? FollowMode::kFree : mode); };
  switch (event->key()) {
    case Qt::Key_1:
      set_camera(CameraPreset::kAnterior);
      break;
    case Qt::Key_2:
      set_camera(CameraPreset::kRightAnteriorOblique);
      break;
    case Qt::Key_3:
      set_camera(CameraPreset::kRight);
      break;
    case Qt::Key_4:
      set_camera(CameraPreset::kLeft);
      break;
    case Qt::Key_5:
      set_camera(CameraPreset::kPosterior);
      break;
    case Qt::Key_6:
      set_camera(CameraPreset::kCranial);
      break;
    case Qt::Key_F:
      toggle(FollowMode::kTip);
      break;
    case Qt::Key_L:
      toggle(FollowMode::kAlongNeedle);
      break;
    case Qt::Key_N:
      toggle(FollowMode::kSide);
      break;
    case Qt::Key_G:
      set_guidance_visible(!is_guidance_visible_);
      break;
    case Qt::Key_M:
      set_landmarks_visible(!are_landmarks_visible_);
      break;
    case Qt::Key_Home:
      reset_camera();
      break;
    case Qt::Key_Left:
      turn(-kKeyOrbit_rad, 0.0);
      break;
    case Qt::Key_Right:
      turn(kKeyOrbit_rad, 0.0);
      break;
    case Qt::Key_Up:
      turn(0.0, kKeyOrbit_rad);
      break;
    case Qt::Key_Down:
      turn(0.0, -kKeyOrbit_rad);
      break;
    case Qt::Key_Plus:
      set_view(zoomed(view(), kZoomPerNotch));
      break;
    case Qt::Key_Minus:
      set_view(zoomed(view(), 1.0 / kZoomPerNotch));
      break;
    default:
      return QWidget::keyPressEvent(event);
  }
  Q_EMIT changed();
}

}  // namespace trocar::trainer
