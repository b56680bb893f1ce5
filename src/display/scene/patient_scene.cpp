#include "scene/patient_scene.h"

#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkNew.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cmath>

#include "core/result.h"
#include "scene/detail/drawing.h"
#include "scene/detail/guide_layer.h"
#include "scene/detail/plane_layer.h"
#include "scene/detail/simplify.h"
#include "scene/detail/surface_layer.h"
#include "scene/detail/tool_layer.h"
#include "scene/detail/volume_copy.h"
#include "scene/detail/volume_layer.h"
#include "scene/input_watch.h"
#include "scene/render_patient.h"

namespace trocar::scene {
namespace {

constexpr double kLeastNeedle_px = 2.6;  ///< Thickness of a needle at least.
constexpr int kPlanePixels = 320;
constexpr int kPlanePixelsMoving = 192;
constexpr double kCutBeforeNeedle_mm = 1.5;  ///< A cut does not clip the needle and what is so far in front of it.

}  // namespace

struct PatientScene::Impl {
  Impl(int columns, int rows) {
    window->SetShowWindow(false);
    window->SetOffScreenRendering(1);
    window->SetSize(columns, rows);
    detail::add_lights(*renderer);
    renderer->SetMaximumNumberOfPeels(detail::kDepthPeels);
    renderer->SetOcclusionRatio(0.01);
    window->SetMultiSamples(0);
    window->SetAlphaBitPlanes(1);
    window->AddRenderer(renderer);
    abort_check->SetClientData(this);
    abort_check->SetCallback([](vtkObject*, unsigned long, void* client, void*) {
      auto& impl = *static_cast<Impl*>(client);
      if (impl.frame_break.is_wanted()) impl.window->SetAbortRender(1);
    });
    abort_tag = window->AddObserver(vtkCommand::AbortCheckEvent, abort_check);
  }
  ~Impl() {
    window->RemoveObserver(abort_tag);
    window->RemoveRenderer(renderer);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  double aspect() const {
    const int* size = window->GetSize();
    return static_cast<double>(std::max(1, size[0])) / std::max(1, size[1]);
  }
  void poll();
  void set_motion(const motion::PatientMotion& now);
  /// Sets the path again, on the skin of the displayed patient.
  void lay_path() {
    static const volume::FloatGrid kNoSkin;
    const volume::FloatGrid& skin = patient ? patient->skin_distance_mm : kNoSkin;
    const Vec3 begin_P = path_P ? path_P->a : Vec3::Zero();
    guides.set_path(path_P, {entry_centre_P.value_or(begin_P), entry_radius_mm}, skin, motion);
    has_changed = true;
  }
  void place_camera(int rows);
  void prepare(const Detail& detail, Eye eye);
  void set_up_stereo(Eye eye);
  /// The rows that VTK draws for the left eye are those of the right eye on the screen.
  bool has_rows_of_other_eye() const;

  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkCallbackCommand> abort_check;
  unsigned long abort_tag = 0;
  detail::CallersBreak frame_break;
  std::shared_ptr<const anatomy::VirtualPatient> patient;
  motion::PatientMotion motion;
  std::string target_name, around_name;
  std::optional<StructurePreset> structure_preset;
  std::optional<Segment> path_P;
  double entry_radius_mm = 0.0;
  std::optional<Vec3> entry_centre_P;
  detail::SurfaceLayer surfaces{*renderer.Get(), frame_break};
  detail::ToolLayer tools{*renderer.Get()};
  detail::HandLayer hand{*renderer.Get()};
  detail::GuideLayer guides{*renderer.Get()};
  detail::PlaneLayer planes{*renderer.Get()};
  detail::VolumeLayer volume{*renderer.Get()};
  CameraView view;
  std::optional<CameraPreset> wanted_preset;  ///< Applied when the scene has content.
  FollowMode follow = FollowMode::kFree;
  bool is_follow_new = false;
  StereoOptions stereo;
  int first_row = 0;
  std::string renderer_name;
  bool has_changed = true;
};

void PatientScene::Impl::poll() {
  if (surfaces.poll()) has_changed = true;
  if (volume.poll()) has_changed = true;
  if (wanted_preset) {
    std::vector<Vec3> outline_P = surfaces.outline_P();
    if (outline_P.empty() && patient)
      outline_P = detail::skin_points(*patient);  // the first surfaces are still being made
    if (outline_P.empty()) return;
    view = fit_camera(outline_P, *wanted_preset, aspect());
    wanted_preset.reset();
    is_follow_new = true;
    has_changed = true;
  }
}

void PatientScene::Impl::set_motion(const motion::PatientMotion& now) {
  if (now.is_same_place(motion)) return;
  motion = now;
  surfaces.set_motion(now);
  planes.set_motion(now);
  guides.set_motion(now);
  lay_path();
}

void PatientScene::Impl::place_camera(int rows) {
  const auto needle_P = tools.needle_P();
  if (needle_P && follow != FollowMode::kFree) {
    view = following(view, follow, *needle_P, is_follow_new);
    is_follow_new = false;
  }
  guides.look_from(view);
  if (follow == FollowMode::kSide && needle_P) {
    const Vec3 back_P = -view.forward_P();
    surfaces.set_cut(std::pair(Vec3(needle_P->b + kCutBeforeNeedle_mm * back_P), back_P));
  } else {
    surfaces.set_cut(std::nullopt);
  }
  tools.set_transducer_translucent(needle_P && follow == FollowMode::kAlongNeedle);
  if (needle_P) tools.set_least_thickness(kLeastNeedle_px * view.mm_per_pixel(needle_P->b, rows));
}

bool PatientScene::Impl::has_rows_of_other_eye() const {
  if (stereo.mode != StereoMode::kInterlaced) return false;
  // VTK assigns the first row from below to the left eye; in a mirrored picture it is the first row from above.
  const int rows = window->GetSize()[1];
  return (first_row + (stereo.is_mirrored_up_down ? 0 : rows - 1)) % 2 != 0;
}

void PatientScene::Impl::set_up_stereo(Eye eye) {
  const bool is_on = stereo.mode != StereoMode::kOff;
  if (is_on) window->SetStereoType(detail::to_vtk(stereo.mode, eye));
  window->SetStereoRender(is_on);
  const bool is_swapped = stereo.swaps_eyes != has_rows_of_other_eye();
  renderer->GetActiveCamera()->SetEyeAngle(is_swapped ? -stereo.eye_angle_deg : stereo.eye_angle_deg);
}

void PatientScene::Impl::prepare(const Detail& detail, Eye eye) {
  const bool draws_volume = detail.has_volume && volume.is_ready();
  place_camera(window->GetSize()[1]);
  planes.update(tools.needle_P(), detail == DetailPolicy::full() ? kPlanePixels : kPlanePixelsMoving);
  surfaces.set_level(detail.mesh_level);
  surfaces.set_visible(!draws_volume);
  if (detail.mesh_level > 0) surfaces.draw_coarse_last();
  volume.set_visible(draws_volume);
  renderer->SetUseDepthPeeling(detail.is_peeled);
  renderer->SetUseFXAA(detail.is_smooth);
  CameraView shown = view;
  if (stereo.mode != StereoMode::kOff) shown.focus_P += stereo.focus_shift * (view.focus_P - view.eye_P);
  detail::apply(shown, *renderer);
  set_up_stereo(eye);
}

PatientScene::PatientScene(int columns, int rows) : impl_(std::make_unique<Impl>(columns, rows)) {}
PatientScene::~PatientScene() = default;

Result<std::unique_ptr<PatientScene>> PatientScene::make(int columns, int rows) {
  if (!detail::has_opengl_display()) {
    return fail("3D pictures need an X server, and there is none", "DISPLAY", "start the program under xvfb-run");
  }
  return std::unique_ptr<PatientScene>(new PatientScene(columns, rows));
}

void PatientScene::show_patient(std::shared_ptr<const anatomy::VirtualPatient> patient,
                                std::shared_ptr<const std::vector<anatomy::NamedMesh>> meshes,
                                std::optional<Vec3> target_P) {
  Impl& s = *impl_;
  if (!target_P && !patient->paths.empty()) target_P = patient->paths.front().line_P.b;
  const Aim aim = target_P ? find_aim(*patient, *target_P) : Aim{};
  s.target_name = aim.target_name;
  s.around_name = aim.around_name;
  s.structure_preset.reset();
  s.set_motion({});
  s.surfaces.clear();
  s.planes.set_patient(patient.get());
  s.guides.set_landmarks(patient->landmarks);
  s.volume.set_patient(patient);
  s.patient = std::move(patient);
  add_surfaces(std::move(meshes));
  s.lay_path();
  s.wanted_preset = CameraPreset::kRightAnteriorOblique;
  s.has_changed = true;
}

void PatientScene::add_surfaces(std::shared_ptr<const std::vector<anatomy::NamedMesh>> meshes) {
  Impl& s = *impl_;
  const anatomy::LabelTable& table = s.patient->label_table;
  std::vector<StructureInfo> structures = describe_structures(table, *meshes, s.target_name, s.around_name);
  if (s.structure_preset)
    for (StructureInfo& info : structures) info.opacity = preset_opacity(info, *s.structure_preset, s.around_name);
  s.surfaces.add(std::move(structures), std::move(meshes), table);
}

bool PatientScene::is_ready() const noexcept {
  return impl_->surfaces.is_ready();
}

void PatientScene::finish_loading() {
  impl_->volume.wait();
  do {
    impl_->surfaces.wait();
    impl_->poll();
  } while (!impl_->surfaces.is_ready());
}

const std::vector<StructureInfo>& PatientScene::structures() const noexcept {
  return impl_->surfaces.structures();
}

void PatientScene::set_opacity(std::string_view name, double opacity) {
  if (impl_->surfaces.set_opacity(name, opacity)) impl_->has_changed = true;
}

void PatientScene::apply_preset(StructurePreset preset) {
  impl_->structure_preset = preset;
  const std::vector<StructureInfo> structures = impl_->surfaces.structures();
  for (const StructureInfo& structure : structures) {
    set_opacity(structure.name, preset_opacity(structure, preset, impl_->around_name));
  }
}

void PatientScene::set_path(const std::optional<Segment>& line_P, double entry_radius_mm) {
  Impl& s = *impl_;
  const bool is_same = line_P.has_value() == s.path_P.has_value() && entry_radius_mm == s.entry_radius_mm &&
                       (!line_P || (line_P->a == s.path_P->a && line_P->b == s.path_P->b));
  if (is_same) return;
  s.path_P = line_P;
  s.entry_radius_mm = entry_radius_mm;
  s.lay_path();
}

void PatientScene::set_other_paths(std::span<const Segment> lines_P) {
  impl_->guides.set_other_paths(lines_P);
  impl_->has_changed = true;
}

void PatientScene::set_entry_centre(const std::optional<Vec3>& centre_P) {
  if (centre_P == impl_->entry_centre_P) return;
  impl_->entry_centre_P = centre_P;
  impl_->lay_path();
}

void PatientScene::set_guidance(Guidance guidance) {
  const bool has_other_marks = impl_->guides.set_guidance(guidance);
  if (impl_->surfaces.withhold_lesions(guidance == Guidance::kNone) || has_other_marks) impl_->has_changed = true;
}

Guidance PatientScene::guidance() const noexcept {
  return impl_->guides.guidance();
}

void PatientScene::set_guidance_visible(bool is_visible) {
  if (impl_->guides.set_guidance_visible(is_visible)) impl_->has_changed = true;
}

void PatientScene::set_landmarks(const std::vector<anatomy::Landmark>& landmarks) {
  impl_->guides.set_landmarks(landmarks);
  impl_->has_changed = true;
}

void PatientScene::set_landmarks_visible(bool are_visible) {
  if (impl_->guides.set_landmarks_visible(are_visible)) impl_->has_changed = true;
}

void PatientScene::show(const SceneView& view) {
  Impl& s = *impl_;
  s.set_motion(view.motion);
  bool has_changed = s.tools.set_needle(view.shaft_P, view.diameter_mm, view.model);
  has_changed |= s.tools.set_needle_goal(view.goal_P);
  has_changed |= s.tools.set_shot(view.stylet_P, view.core_P);
  has_changed |= s.tools.set_throw(view.throw_P, view.notch_P);
  has_changed |= s.hand.set(view.finger, view.skin_marks_P);
  has_changed |= s.tools.set_scan(view.scan);
  s.has_changed = s.has_changed || has_changed;
}

void PatientScene::set_mpr(const MprOptions& options) {
  if (impl_->planes.set_options(options)) impl_->has_changed = true;
}

const MprOptions& PatientScene::mpr() const noexcept {
  return impl_->planes.options();
}

void PatientScene::set_volume_preset(VolumePreset preset) {
  if (impl_->volume.set_preset(preset, has_gpu())) impl_->has_changed = true;
}

VolumePreset PatientScene::volume_preset() const noexcept {
  return impl_->volume.preset();
}

void PatientScene::set_camera(CameraPreset preset) {
  impl_->follow = FollowMode::kFree;
  impl_->wanted_preset = preset;
  impl_->has_changed = true;
}

void PatientScene::set_view(const CameraView& view) {
  impl_->view = view;
  impl_->wanted_preset.reset();
  impl_->has_changed = true;
}

const CameraView& PatientScene::view() const noexcept {
  return impl_->view;
}

void PatientScene::set_follow(FollowMode mode) {
  if (mode == impl_->follow) return;
  impl_->follow = mode;
  impl_->is_follow_new = true;
  impl_->has_changed = true;
}

FollowMode PatientScene::follow() const noexcept {
  return impl_->follow;
}

void PatientScene::set_stereo(const StereoOptions& options) {
  if (options == impl_->stereo) return;
  impl_->stereo = options;
  impl_->has_changed = true;
}

const StereoOptions& PatientScene::stereo() const noexcept {
  return impl_->stereo;
}

void PatientScene::set_size(int columns, int rows) {
  impl_->window->SetSize(columns, rows);
}

void PatientScene::set_text_scale(double scale) {
  if (impl_->guides.set_text_scale(scale)) impl_->has_changed = true;
}

void PatientScene::set_first_row(int row) {
  const int parity = row & 1;
  if (parity == impl_->first_row) return;
  impl_->first_row = parity;
  if (impl_->stereo.mode == StereoMode::kInterlaced) impl_->has_changed = true;
}

void PatientScene::poll() {
  impl_->poll();
}

bool PatientScene::has_changed() const noexcept {
  return impl_->has_changed;
}

bool PatientScene::render(const Detail& detail, const std::function<bool()>& wants_break, Eye eye) {
  Impl& s = *impl_;
  s.poll();
  s.prepare(detail, eye);
  s.frame_break.begin(wants_break);
  s.window->SetAbortRender(0);
  s.window->Render();
  s.frame_break.end();
  if (s.renderer_name.empty()) s.renderer_name = detail::renderer_of(*s.window);
  if (s.frame_break.has_broken()) return false;
  s.has_changed = false;
  return true;
}

void PatientScene::copy_picture(std::span<std::uint32_t> pixels) const {
  detail::copy_picture(*impl_->window, pixels);
  detail::mirror(pixels, impl_->window->GetSize()[0], impl_->stereo.is_mirrored_left_right,
                 impl_->stereo.is_mirrored_up_down);
}

std::optional<Vec3> PatientScene::pick(double right, double down) {
  Impl& s = *impl_;
  const CameraView& view = s.view;
  const double half_height = std::tan(0.5 * view.view_angle_rad);
  const Vec3 ray_P = (view.forward_P() + (1.0 - 2.0 * down) * half_height * view.up_P +
                      (2.0 * right - 1.0) * half_height * s.aspect() * view.right_P())
                         .normalized();
  std::optional<double> nearest_mm;
  for (const StructureInfo& structure : s.surfaces.structures()) {
    if (structure.opacity <= 0.0 || structure.is_withheld) continue;
    const TriangleMesh now_P = detail::moved_mesh(s.surfaces.mesh_A(structure.name), s.motion);
    const auto hit_mm = detail::first_hit_mm(now_P, view.eye_P, ray_P);
    if (hit_mm && (!nearest_mm || *hit_mm < *nearest_mm)) nearest_mm = hit_mm;
  }
  return nearest_mm ? std::optional<Vec3>(view.eye_P + *nearest_mm * ray_P) : std::nullopt;
}

std::string PatientScene::renderer_name() const {
  return impl_->renderer_name;
}

bool PatientScene::has_gpu() const {
  return !impl_->renderer_name.empty() && !detail::is_software_renderer(impl_->renderer_name);
}

std::size_t PatientScene::triangle_count(int mesh_level) const {
  return impl_->surfaces.triangle_count(mesh_level);
}

}  // namespace trocar::scene
