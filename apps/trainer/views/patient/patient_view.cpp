#include "views/patient/patient_view.h"

#include <QPainter>

#include "core/result.h"
#include "scene/input_watch.h"
#include "ui_kit/theme.h"
#include "views/patient/stereo_output.h"

namespace trocar::trainer {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kFirstSize_px = 64;  ///< Used before the widget has a size.
/// Minimum interval of input checks while a picture is rendered.
constexpr std::chrono::milliseconds kWatchEvery{4};

double in_ms(Clock::duration time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

}  // namespace

struct PatientView::Impl {
  void note_watch(Clock::time_point now) {
    unwatched_times.add(in_ms(now - last_watch));
    last_watch = now;
  }

  std::unique_ptr<scene::PatientScene> scene;
  QImage image;                     ///< Of the last complete frame; of the left eye with shutter glasses.
  StereoOutput* shutter = nullptr;  ///< Created when shutter glasses are selected.
  QWidget* shutter_cover = nullptr;
  scene::DetailPolicyParams params;
  std::unique_ptr<scene::DetailPolicy> policy;  ///< Created when the renderer is known.
  scene::Detail drawn;                          ///< Of the last complete frame.
  bool has_drawn = false;
  bool are_tools_moving = false;
  bool is_drawing = false;
  QSize drawn_size;  ///< Size of the widget in the last complete frame.
  scene::FrameTimes moving_times;
  scene::FrameTimes still_times;
  scene::FrameTimes unwatched_times;
  int broken_frames = 0;
  QString note;
  scene::InputWatch watch;
  Clock::time_point last_watch{};
  std::function<bool()> interrupt;
  std::function<int(int)> row_on_screen;
};

PatientView::PatientView(QWidget* parent) : QWidget(parent), impl_(std::make_unique<Impl>()) {
  Result<std::unique_ptr<scene::PatientScene>> scene = scene::PatientScene::make(kFirstSize_px, kFirstSize_px);
  TROCAR_CHECK(scene);  // main() has checked can_render()
  impl_->scene = std::move(*scene);
  setAttribute(Qt::WA_OpaquePaintEvent);
  setFocusPolicy(Qt::StrongFocus);
  setObjectName(QStringLiteral("patient-view"));
  setAccessibleName(tr("3D view of the patient"));
  setToolTip(
      tr("Drag: rotate · Shift+drag: pan · wheel: zoom · 1–6: views · T: follow the tip · L: along the needle · B: "
         "side view"));
}

PatientView::~PatientView() = default;

void PatientView::note_motion() {
  if (impl_->policy) impl_->policy->note_motion(Clock::now());
}

void PatientView::show_patient(std::shared_ptr<const anatomy::VirtualPatient> patient,
                               std::shared_ptr<const std::vector<anatomy::NamedMesh>> meshes,
                               const std::optional<Vec3>& target_P) {
  impl_->scene->show_patient(std::move(patient), std::move(meshes), target_P);
}

void PatientView::add_surfaces(std::shared_ptr<const std::vector<anatomy::NamedMesh>> meshes) {
  impl_->scene->add_surfaces(std::move(meshes));
}

void PatientView::set_note(const QString& note) {
  if (std::exchange(impl_->note, note) != note) update();
}

bool PatientView::is_ready() const {
  return impl_->scene->is_ready();
}

void PatientView::set_path(const std::optional<Segment>& line_P, double entry_radius_mm) {
  impl_->scene->set_path(line_P, entry_radius_mm);
}

void PatientView::set_other_paths(std::span<const Segment> lines_P) {
  impl_->scene->set_other_paths(lines_P);
}

void PatientView::set_guidance(scene::Guidance guidance) {
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

std::vector<scene::StructureInfo> PatientView::structures() const {
  return impl_->scene->structures();
}

void PatientView::set_opacity(std::string_view name, double opacity) {
  impl_->scene->set_opacity(name, opacity);
}

void PatientView::apply_preset(scene::StructurePreset preset) {
  impl_->scene->apply_preset(preset);
}

void PatientView::set_volume_preset(scene::VolumePreset preset) {
  impl_->scene->set_volume_preset(preset);
}

scene::VolumePreset PatientView::volume_preset() const {
  return impl_->scene->volume_preset();
}

void PatientView::set_mpr(const scene::MprOptions& options) {
  impl_->scene->set_mpr(options);
}

scene::MprOptions PatientView::mpr() const {
  return impl_->scene->mpr();
}

void PatientView::set_camera(scene::CameraPreset preset) {
  impl_->scene->set_camera(preset);
}

void PatientView::set_view(const scene::CameraView& view) {
  impl_->scene->set_view(view);
}

const scene::CameraView& PatientView::view() const {
  return impl_->scene->view();
}

void PatientView::set_follow(scene::FollowMode mode) {
  impl_->scene->set_follow(mode);
}

scene::FollowMode PatientView::follow() const {
  return impl_->scene->follow();
}

void PatientView::face(const Vec3& outward_P) {
  home_ = scene::preset_facing(outward_P);
  reset_camera();
}

void PatientView::reset_camera() {
  set_camera(home_);
}

void PatientView::set_stereo(const scene::StereoOptions& options) {
  Impl& v = *impl_;
  v.scene->set_stereo(options);
  const bool has_shutter = options.mode == scene::StereoMode::kQuadBuffer;
  if (has_shutter && v.shutter == nullptr) {
    v.shutter = new StereoOutput(*this);
    v.shutter_cover = QWidget::createWindowContainer(v.shutter, this);
    v.shutter_cover->setFocusProxy(this);
    v.shutter_cover->setGeometry(rect());
  }
  if (v.shutter_cover != nullptr) v.shutter_cover->setVisible(has_shutter);
}

void PatientView::set_row_on_screen(std::function<int(int)> row_on_screen) {
  impl_->row_on_screen = std::move(row_on_screen);
}

const scene::StereoOptions& PatientView::stereo() const {
  return impl_->scene->stereo();
}

bool PatientView::has_quad_buffer() {
  return StereoOutput::is_offered();
}

void PatientView::set_tools_moving(bool are_moving) {
  impl_->are_tools_moving = are_moving;
}

void PatientView::set_frame_target(double target_ms) {
  impl_->params.target_ms = target_ms;
  if (impl_->policy) impl_->policy->set_target(target_ms);
}

void PatientView::set_interrupt(std::function<bool()> wants_break) {
  impl_->interrupt = std::move(wants_break);
}

const scene::FrameTimes& PatientView::moving_frame_times() const noexcept {
  return impl_->moving_times;
}

const scene::FrameTimes& PatientView::still_frame_times() const noexcept {
  return impl_->still_times;
}

const scene::FrameTimes& PatientView::unwatched_times() const noexcept {
  return impl_->unwatched_times;
}

void PatientView::clear_frame_times() noexcept {
  impl_->unwatched_times.clear();
  impl_->moving_times.clear();
  impl_->still_times.clear();
}

bool PatientView::is_still() const noexcept {
  return impl_->has_drawn && impl_->drawn == scene::DetailPolicy::full();
}

int PatientView::broken_frames() const noexcept {
  return impl_->broken_frames;
}

scene::PatientScene& PatientView::scene() noexcept {
  return *impl_->scene;
}

QSize PatientView::picture_size(const scene::Detail& detail) const {
  // Scaled rows would mix the images of both eyes.
  const double share = stereo().mode == scene::StereoMode::kInterlaced ? 1.0 : detail.resolution;
  return (QSizeF(size()) * devicePixelRatioF() * share).toSize().expandedTo({1, 1});
}

bool PatientView::render_eye(const scene::Detail& detail, bool may_break, scene::Eye eye, QImage& image) {
  Impl& v = *impl_;
  const auto wants_break = [&v] {
    const auto now = Clock::now();
    if (now - v.last_watch < kWatchEvery) return false;
    v.note_watch(now);
    return v.watch.has_happened() || (v.interrupt && v.interrupt());
  };
  if (!v.scene->render(detail, may_break ? std::function<bool()>(wants_break) : nullptr, eye)) return false;
  const QSize size = picture_size(detail);
  if (image.size() != size) image = QImage(size, QImage::Format_RGB32);
  v.scene->copy_picture({reinterpret_cast<std::uint32_t*>(image.bits()),
                         static_cast<std::size_t>(size.width()) * static_cast<std::size_t>(size.height())});
  return true;
}

void PatientView::render(const scene::Detail& detail, bool may_break) {
  Impl& v = *impl_;
  const auto start = Clock::now();
  if (may_break) v.watch.start();
  v.last_watch = start;
  const QSize size = picture_size(detail);
  v.scene->set_size(size.width(), size.height());
  v.scene->set_text_scale(static_cast<double>(size.height()) / std::max(1, height()));
  const bool has_shutter = v.scene->stereo().mode == scene::StereoMode::kQuadBuffer;
  QImage right;
  const bool is_whole = render_eye(detail, may_break, scene::Eye::kLeft, v.image) &&
                        (!has_shutter || render_eye(detail, may_break, scene::Eye::kRight, right));
  const auto end = Clock::now();
  if (may_break) v.note_watch(end);
  const double frame_ms = in_ms(end - start);
  if (!v.policy) v.policy = std::make_unique<scene::DetailPolicy>(v.scene->has_gpu(), v.params);
  if (!is_whole) {
    ++v.broken_frames;
    v.policy->note_motion(end);
    return render(v.policy->next(end), false);
  }
  v.policy->note_frame(detail, frame_ms, end);
  (detail == scene::DetailPolicy::full() ? v.still_times : v.moving_times).add(frame_ms);
  v.drawn = detail;
  v.has_drawn = true;
  v.drawn_size = this->size();
  if (has_shutter) v.shutter->show_eyes(v.image, right);
  update();
}

void PatientView::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  if (impl_->image.isNull()) return painter.fillRect(rect(), theme().view);
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  painter.drawImage(rect(), impl_->image);
  if (impl_->note.isEmpty()) return;
  constexpr int kMargin = 8;
  painter.setPen(theme().dim);
  painter.drawText(rect().adjusted(kMargin, kMargin, -kMargin, -kMargin), Qt::AlignLeft | Qt::AlignBottom, impl_->note);
}

void PatientView::resizeEvent(QResizeEvent* /*event*/) {
  if (impl_->shutter_cover != nullptr) impl_->shutter_cover->setGeometry(rect());
}

void PatientView::draw() {
  Impl& v = *impl_;
  if (v.is_drawing || !isVisible()) return;
  v.is_drawing = true;
  const auto now = Clock::now();
  // The renderer is known only after a frame: the first frame has the lowest detail.
  if (!v.policy) {
    render(scene::DetailPolicy::moving(scene::DetailPolicy::kMovingLevels - 1), false);
    note_motion();
  } else {
    v.scene->poll();
    const int global_row = mapToGlobal(QPoint(0, 0)).y();
    const int row = v.row_on_screen ? v.row_on_screen(global_row) : global_row;
    v.scene->set_first_row(qRound(row * devicePixelRatioF()));
    const bool has_changed = v.scene->has_changed() || v.drawn_size != size();
    if (has_changed || v.are_tools_moving) v.policy->note_motion(now);
    const scene::Detail detail = v.policy->next(now);
    const bool rises = v.drawn != detail && detail == scene::DetailPolicy::full();
    if (has_changed || rises) render(detail, rises && !v.scene->has_gpu());
  }
  v.is_drawing = false;
}

void PatientView::draw_whole() {
  impl_->scene->finish_loading();
  render(scene::DetailPolicy::full(), false);
}

}  // namespace trocar::trainer
