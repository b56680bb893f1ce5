#include "views/patient/patient_view_entry.h"

#include <algorithm>

#include "ui_kit/parts.h"
#include "ui_kit/trainer_application.h"
#include "ui_kit/window_language.h"
#include "ultrasound/live/scan_picture.h"
#include "ultrasound/scanner/scan_annotation.h"
#include "views/patient/patient_view.h"
#include "views/ultrasound/scan_mask.h"

namespace trocar::trainer {
namespace {

/// Frame time available to the 3D views while tools move, so that 15 frames per second remain with slices, ultrasound
/// and curves.
constexpr double kFrameOfOne_ms = 32.0, kFrameOfTwo_ms = 20.0;

enum class Role { kMain, kSide };

scene::TransducerFace face_of(const ultrasound::ScanGeometry& scan) {
  scene::TransducerFace face;
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

class PatientViewEntry final : public View {
 public:
  PatientViewEntry(Role role, ViewContext& context) : role_(role), context_(context), view_(new PatientView) {
    view_->setObjectName(role == Role::kMain ? QStringLiteral("view-3d") : QStringLiteral("view-side"));
    if (role == Role::kMain) context.main_3d_view = view_;
    if (role == Role::kSide) view_->set_follow(scene::FollowMode::kSide);
    context.all_3d_views.push_back(view_);
  }

  QWidget& widget() override { return *view_; }

  bool open(const CaseContext& context) override {
    case_ = context;
    paths_ = {context.open->the_case.plan.line_P, {}};
    picture_.reset();
    tools_ = std::make_shared<const ToolsShown>();
    has_patient_ = false;
    if (role_ == Role::kMain) show_patient();
    return has_patient_;
  }

  void show_help(TrainingMode mode) override {
    view_->set_guidance(guidance_of(mode));
    view_->set_guidance_visible(true);
  }

  void show_expert_paths(const ExpertPaths& paths) override {
    paths_ = paths;
    if (has_patient_) show_paths();
  }

  void show_tools(const ToolContext& context) override {
    tools_ = context.visible;
    has_whole_picture_ = false;
  }

  void take_later_data() override {
    if (!has_patient_) return;
    add_new_surfaces();
    view_->scene().poll();
  }

  void update(const FrameContext& frame) override { view_->set_tools_moving(frame.are_tools_moving); }

  void draw(const FrameContext& frame) override {
    if (!view_->isVisible()) return;
    // The surfaces of the side view cost seconds of computing: only where it is visible.
    if (!has_patient_ && case_.open) show_patient();
    if (!case_.open) return;
    take_picture(frame.are_tools_moving);
    show_frame();
    // Two views share the time of one; while tools move the side view is drawn every other time.
    const auto& all = context_.all_3d_views;
    const bool has_both = std::count_if(all.begin(), all.end(), [](const auto* v) { return v->isVisible(); }) > 1;
    if (has_both && role_ == Role::kSide && frame.are_tools_moving && frame.number % 2 == 0) return;
    const TrainerApplication::DrawingScope drawing;
    view_->set_frame_target(has_both ? kFrameOfTwo_ms : kFrameOfOne_ms);
    view_->draw();
  }

 private:
  void show_patient() {
    const cases::Case& the_case = case_.open->the_case;
    view_->show_patient(the_case.patient, std::make_shared<const std::vector<anatomy::NamedMesh>>(),
                        the_case.plan.line_P.b);
    surface_groups_ = 0;
    add_new_surfaces();
    // The side view follows the needle instead.
    if (role_ == Role::kMain) view_->face(-the_case.plan.line_P.direction());
    show_paths();
    view_->scene().set_entry_centre(case_.entry_zone.centre_P);
    has_patient_ = true;
  }

  void show_paths() {
    view_->set_path(paths_.path_P, case_.entry_zone.radius_mm);
    view_->set_other_paths(paths_.others_P);
  }

  void add_new_surfaces() {
    for (const auto& meshes : case_.open->later->surfaces_after(surface_groups_)) {
      view_->add_surfaces(meshes);
      ++surface_groups_;
    }
    const JobView later = case_.open->later->view();
    // Surfaces that have arrived are still simplified for the graphics.
    const QString step = !later.is_done       ? shown(later.step)
                         : !view_->is_ready() ? PatientView::tr("3D surfaces")
                                              : QString();
    view_->set_note(step.isEmpty() ? step : PatientView::tr("Being prepared: %1").arg(step));
  }

  /// The newest ultrasound image as a plane. With the tools at rest one in full detail stays there: its noise alone is
  /// not worth drawing the patient again.
  void take_picture(bool are_tools_moving) {
    auto newest = context_.ultrasound_picture();
    if (!newest || newest == picture_ || (has_whole_picture_ && !are_tools_moving)) return;
    picture_ = std::move(newest);
    has_whole_picture_ = picture_->detail == ultrasound::ScanDetail::kFull;
  }

  void show_frame() {
    const tasks::Needle& needle = case_.open->the_case.needle;
    scene::SceneView view;
    view.motion = tools_->motion;
    view.shaft_P = tools_->shaft_P;
    view.diameter_mm = needle.outer_diameter_mm;
    view.model = scene::needle_model(needle.model);
    view.goal_P = tools_->goal_P;
    view.stylet_P = tools_->stylet_P;
    view.core_P = tools_->core_P;
    view.throw_P = tools_->throw_P;
    view.notch_P = tools_->notch_P;
    view.finger = tools_->finger;
    view.skin_marks_P = tools_->skin_marks_P;
    if (picture_) view.scan = scan_of(*picture_);
    view_->scene().show(view);
  }

  /// Pixels outside of the scan are transparent.
  scene::ScanView scan_of(const ultrasound::ScanPicture& picture) {
    scene::ScanView scan;
    scan.X_PT = picture.X_PT;
    scan.face = face_of(picture.scan);
    scan.picture =
        picture.colour.pixels.empty() ? scene::PictureView(picture.gray) : scene::PictureView(picture.colour);
    scan.alpha = mask_.of(scan.picture.columns, scan.picture.rows, picture.corners_P, picture.X_PT, picture.scan);
    scan.corners_P = picture.corners_P;
    scan.number = picture.number;
    return scan;
  }

  Role role_;
  ViewContext& context_;
  PatientView* view_;
  CaseContext case_;
  ExpertPaths paths_;
  bool has_patient_ = false;
  std::size_t surface_groups_ = 0;  ///< Groups of the case's surfaces that the view has.
  std::shared_ptr<const ToolsShown> tools_ = std::make_shared<const ToolsShown>();
  std::shared_ptr<const ultrasound::ScanPicture> picture_;
  ScanMask mask_;
  bool has_whole_picture_ = false;  ///< The picture has full detail.
};

}  // namespace

ViewDescription patient_view_entry() {
  ViewDescription view;
  view.id = QStringLiteral("3d");
  view.title = PatientView::tr("3D");
  view.make = [](ViewContext& context) { return std::make_unique<PatientViewEntry>(Role::kMain, context); };
  return view;
}

ViewDescription side_view_entry() {
  ViewDescription view;
  view.id = QStringLiteral("side");
  view.title = PatientView::tr("Side view");
  view.make = [](ViewContext& context) { return std::make_unique<PatientViewEntry>(Role::kSide, context); };
  return view;
}

}  // namespace trocar::trainer
