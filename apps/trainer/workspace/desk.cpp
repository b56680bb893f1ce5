#include "workspace/desk.h"

#include <QAction>
#include <QDockWidget>
#include <QHBoxLayout>
#include <QLabel>
#include <QSettings>
#include <QTimer>
#include <QToolButton>
#include <algorithm>

#include "attempt/guide/needle_shaft.h"
#include "panels/structure_panel.h"
#include "shell/trainer_application.h"
#include "slices/slice_geometry.h"
#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "ultrasound/scanner/scan_annotation.h"
#include "views/patient/patient_view.h"
#include "views/plots/force_plot.h"
#include "views/slices/slice_marks.h"
#include "views/slices/slice_view.h"
#include "views/ultrasound/scanner_view.h"
#include "views/ultrasound/ultrasound_controls.h"
#include "views/ultrasound/ultrasound_view.h"
#include "views/view_strip.h"
#include "workspace/layouts.h"

namespace trocar::trainer {
namespace {

constexpr double kEntryZone_mm = 10.0;
/// So that all layouts fit next to the tissue panel on a screen of 1024x768.
constexpr QSize kLeastView(130, 100);
/// Frame time available to the 3D views while tools move, so that 15 frames per second remain with slices, ultrasound
/// and curves.
constexpr double kFrameOfOne_ms = 32.0, kFrameOfTwo_ms = 20.0;

/// The task's entry zone, else the skin around the planned entry.
tasks::EntryZone entry_zone_of(const cases::Case& the_case) {
  return the_case.task.entry_zone.value_or(tasks::EntryZone{the_case.plan.line_P.a, kEntryZone_mm});
}

/// A slim title with buttons to undock and to hide the view.
QWidget* make_title(QDockWidget& dock, QWidget& line) {
  auto* bar = new QFrame;
  bar->setProperty("role", "bar");
  auto* row = new QHBoxLayout(bar);
  row->setContentsMargins(0, 0, 2, 0);
  row->setSpacing(2);
  row->addWidget(&line, 1);
  const auto add = [&](const QString& text, const QString& tooltip) {
    auto* button = new QToolButton;
    button->setText(text);
    button->setToolTip(tooltip);
    button->setAutoRaise(true);
    button->setFocusPolicy(Qt::NoFocus);
    button->setStyleSheet(
        QStringLiteral("QToolButton { border: none; background: transparent; padding: 0 5px; color: %1; }"
                       "QToolButton:hover { color: %2; }")
            .arg(theme().dim.name(), theme().accent.name()));
    row->addWidget(button);
    return button;
  };
  QObject::connect(add(QStringLiteral("❐"), Desk::tr("Undock the view, or dock it again")), &QToolButton::clicked,
                   &dock, [&dock] { dock.setFloating(!dock.isFloating()); });
  QObject::connect(add(QStringLiteral("✕"), Desk::tr("Hide the view; show it again with the menu Views")),
                   &QToolButton::clicked, &dock, &QDockWidget::hide);
  return bar;
}

/// Invisible motion: a tool at rest moves with the noise of the servo, and each change costs a frame.
constexpr double kUnseen_mm = 0.03, kUnseen_rad = 5e-4;

bool are_near(const Pose& a, const Pose& b) {
  return (a.p() - b.p()).norm() < kUnseen_mm && (a.R() - b.R()).norm() < kUnseen_rad;
}

bool are_near(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(),
                                            [](const Vec3& p, const Vec3& q) { return (p - q).norm() < kUnseen_mm; });
}

bool are_same(const std::optional<Segment>& s, const std::optional<Segment>& t) {
  if (!s || !t) return !s && !t;
  return (s->a - t->a).norm() < kUnseen_mm && (s->b - t->b).norm() < kUnseen_mm;
}

bool are_same(const ToolsShown& a, const ToolsShown& b) {
  return are_near(a.shaft_P, b.shaft_P) && are_near(a.X_PN, b.X_PN) && a.X_PT.has_value() == b.X_PT.has_value() &&
         (!a.X_PT || are_near(*a.X_PT, *b.X_PT)) && are_same(a.hand_P, b.hand_P) && are_same(a.stylet_P, b.stylet_P) &&
         are_same(a.core_P, b.core_P) && a.focus_P.has_value() == b.focus_P.has_value() &&
         (!a.focus_P || (*a.focus_P - *b.focus_P).norm() < kUnseen_mm);
}

/// Visible part of the tools from outside the patient: the needle up to the skin.
ToolsShown seen_from_outside(ToolsShown tools) {
  tools.shaft_P = attempt::shaft_outside(std::move(tools.shaft_P), tools.inside_mm);
  if (!tools.shaft_P.empty()) tools.X_PN = Pose(tools.X_PN.R(), tools.shaft_P.back());
  if (tools.inside_mm > 0.0) tools.hand_P.reset();
  tools.stylet_P.reset();
  tools.core_P.reset();
  tools.focus_P.reset();
  return tools;
}

}  // namespace

Desk::Desk(QWidget* parent) : QMainWindow(parent) {
  setObjectName(QStringLiteral("desk"));
  setDockNestingEnabled(true);
  setDockOptions(QMainWindow::AllowNestedDocks | QMainWindow::AllowTabbedDocks);
  view_3d_ = new PatientView;
  side_ = new PatientView;
  forces_ = new ForcePlot;
  ultrasound_ = new UltrasoundView;
  ultrasound_controls_ = new UltrasoundControls(*ultrasound_);
  for (const SliceKind kind : {SliceKind::kAxial, SliceKind::kCoronal, SliceKind::kSagittal, SliceKind::kAlongNeedle,
                               SliceKind::kAcrossNeedle})
    slices_.push_back(new SliceView(kind));
  for (SliceView* slice : slices_) marks_.push_back(new SliceMarks(slice));
  auto* scanner = new ScannerView(*ultrasound_, *ultrasound_controls_);

  add_view("3d", tr("3D"), *view_3d_);
  add_view("side", tr("Side view"), *side_);
  add_view("ultrasound", tr("Ultrasound"), *scanner);
  add_knobs_button();
  add_view("forces", tr("Resistance"), *forces_, &forces_->strip());
  structures_ = new StructurePanel(*view_3d_);
  add_view("structures", tr("Structures"), *structures_);
  const std::pair<const char*, QString> slices[] = {{"axial", tr("Axial")},
                                                    {"coronal", tr("Coronal")},
                                                    {"sagittal", tr("Sagittal")},
                                                    {"along", tr("Along the needle")},
                                                    {"across", tr("Across the tip")}};
  for (std::size_t s = 0; s < slices_.size(); ++s)
    add_view(slices[s].first, slices[s].second, *slices_[s], &slices_[s]->strip());
  view_3d_->setObjectName(QStringLiteral("view-3d"));
  side_->setObjectName(QStringLiteral("view-side"));
  side_->set_follow(scene::FollowMode::kSide);
  connect_views();
  choose_layout(QSettings().value(QStringLiteral("desk/layout"), built_in_layouts().front().name).toString());
}

void Desk::add_view(const char* name, const QString& title, QWidget& view, QWidget* strip) {
  auto* dock = new QDockWidget(title, this);
  dock->setObjectName(QStringLiteral("dock-") + QString::fromLatin1(name));
  if (strip == nullptr) {
    strip = make_label(title, "dim");
    strip->setContentsMargins(8, 1, 0, 1);
  }
  dock->setTitleBarWidget(make_title(*dock, *strip));
  if (&view != structures_) view.setMinimumSize(kLeastView);  // a control panel needs its own
  dock->setWidget(&view);
  addDockWidget(Qt::LeftDockWidgetArea, dock);
  dock->hide();  // the layout decides
  docks_[QString::fromLatin1(name)] = dock;
  const auto note = [this] { QTimer::singleShot(0, this, &Desk::note_shares); };
  connect(dock, &QDockWidget::dockLocationChanged, this, note);
  connect(dock, &QDockWidget::topLevelChanged, this, note);
}

/// In the title of the ultrasound view, where it does not cover the image.
void Desk::add_knobs_button() {
  auto* knobs = make_tool_button("ultrasound-knobs", tr("Knobs"), tr("Image controls next to the ultrasound image"),
                                 QStringLiteral("K"));
  knobs->setCheckable(true);
  knobs->setFocusPolicy(Qt::NoFocus);
  knobs->setStyleSheet(QStringLiteral("QToolButton { padding: 0 8px; min-height: 0; }"));
  auto* row = qobject_cast<QHBoxLayout*>(docks_.at(QStringLiteral("ultrasound"))->titleBarWidget()->layout());
  row->insertWidget(1, knobs);
  connect(knobs, &QToolButton::toggled, ultrasound_controls_, &QWidget::setVisible);
}

void Desk::connect_views() {
  for (SliceView* slice : slices_) {
    connect(slice, &SliceView::focus_moved, this, [this](const Vec3& p_P) {
      for (SliceView* other : slices_) other->set_focus(p_P);
    });
    connect(slice, &SliceView::window_changed, this, [this](double centre_hu, double width_hu) {
      for (SliceView* other : slices_) other->set_window(centre_hu, width_hu);
    });
  }
}

void Desk::show_in_space(PatientView& view) {
  view.show_patient(open_->the_case.patient, open_->meshes, open_->the_case.plan.line_P.b);
  const tasks::EntryZone zone = entry_zone_of(open_->the_case);
  view.set_path(open_->the_case.plan.line_P, zone.radius_mm);
  view.scene().set_entry_centre(zone.centre_P);
}

void Desk::show_case(std::shared_ptr<const cases::OpenCase> open) {
  begin_case(std::move(open));
  while (show_part()) {
  }
}

void Desk::begin_case(std::shared_ptr<const cases::OpenCase> open) {
  open_ = std::move(open);
  has_side_patient_ = false;
  picture_number_ = 0;
  tools_.reset();
  shown_ = {};
  parts_shown_ = 0;
}

bool Desk::show_part() {
  switch (parts_shown_++) {
    case 0:
      show_in_space(*view_3d_);
      return true;
    case 1:
      structures_->rebuild();
      return true;
    case 2:
      show_in_slices();
      return true;
    case 3:
      ultrasound_->show_patient(open_->acoustic, open_->flow, open_->transducer);
      ultrasound_->change_settings([&](UltrasoundSettings& s) { s.acquisition.depth_mm = open_->probe_depth_mm; });
      return true;
    default:
      return false;
  }
}

void Desk::show_in_slices() {
  const cases::Case& the_case = open_->the_case;
  const slices::Box body_P = slices::body_box(*the_case.patient);
  for (SliceView* slice : slices_) {
    slice->show_patient(the_case.patient, body_P);
    slice->set_path(the_case.plan.line_P);
    slice->set_entry_zone(entry_zone_of(the_case));
    slice->set_focus(the_case.plan.line_P.b);
  }
}

void Desk::show_help(Difficulty difficulty) {
  const scene::Guidance guidance = guidance_of(difficulty);
  for (PatientView* view : {view_3d_, side_}) {
    view->set_guidance(guidance);
    view->set_guidance_visible(true);
  }
  for (SliceView* slice : slices_) slice->set_guidance(guidance);
  ultrasound_->set_guide_offered(difficulty != Difficulty::kExam);
  ultrasound_->set_guide_visible(guidance == scene::Guidance::kPath);
  structures_->refresh();
}

void Desk::set_tip_hidden(bool is_hidden) {
  is_tip_hidden_ = is_hidden;
  tools_.reset();
  forces_->set_depth_shown(!is_hidden);
  for (SliceView* slice : slices_) {
    slice->set_frame_at_skin(is_hidden);
    slice->set_needle({});
    if (is_hidden) slice->set_focus(slices::body_box(*open_->the_case.patient).center());
  }
}

void Desk::show_tools(const ToolsShown& tools) {
  for (PatientView* view : {view_3d_, side_}) view->set_tools_moving(tools.are_moving);
  are_moving_ = tools.are_moving;
  if (tools_ && are_same(tools, *tools_)) return;
  tools_ = tools;
  shown_ = is_tip_hidden_ ? seen_from_outside(tools) : tools;
  has_whole_picture_ = false;
  const tasks::Needle& needle = open_->the_case.needle;
  for (PatientView* view : {view_3d_, side_}) {
    view->set_needle(shown_.shaft_P, needle.outer_diameter_mm, scene::needle_model(needle.model));
    view->set_hand(shown_.hand_P);
    view->set_shot(shown_.stylet_P, shown_.core_P);
  }
  for (SliceMarks* marks : marks_) marks->set_shot(shown_.stylet_P, shown_.core_P);
  stale_slices_ = (1U << slices_.size()) - 1U;
  std::vector<Vec3> metal_P = tools.shaft_P;  // the stylet is visible in ultrasound, too
  if (tools.stylet_P) metal_P.push_back(tools.stylet_P->b);
  ultrasound_->set_needle(metal_P, needle.outer_diameter_mm);
  if (tools.X_PT) ultrasound_->set_transducer_pose(*tools.X_PT);
}

void Desk::draw(double now_s) {
  // Computing its surfaces takes seconds: only if they are visible.
  if (!has_side_patient_ && side_->isVisible()) {
    show_in_space(*side_);
    has_side_patient_ = true;
  }
  if (structures_->isVisible()) structures_->refresh();
  ultrasound_->advance(now_s);
  follow_with_slices();
  show_picture_in_space();
  const TrainerApplication::DrawingScope drawing;
  draw_in_space();
}

/// Two views share the time of one; while tools move, the side view is drawn in every second frame.
void Desk::draw_in_space() {
  const bool has_both = view_3d_->isVisible() && side_->isVisible();
  for (PatientView* view : {view_3d_, side_}) {
    view->set_frame_target(has_both ? kFrameOfTwo_ms : kFrameOfOne_ms);
    if (view->isVisible() && !(has_both && view == side_ && are_moving_ && frame_ % 2 == 0)) view->draw();
  }
}

/// Slices follow the tools; while tools move, each slice is updated in every second frame to save processor time.
void Desk::follow_with_slices() {
  ++frame_;
  for (std::size_t s = 0; s < slices_.size(); ++s) {
    const unsigned bit = 1U << s;
    if ((stale_slices_ & bit) == 0 || (are_moving_ && (frame_ + s) % 2 != 0)) continue;
    stale_slices_ &= ~bit;
    slices_[s]->set_needle(shown_.shaft_P);
    if (!shown_.shaft_P.empty()) slices_[s]->set_needle_frame(shown_.X_PN);
    if (shown_.focus_P) slices_[s]->set_focus(*shown_.focus_P);
  }
}

/// The newest ultrasound image as a plane in the 3D views. With the tools at rest, one full-detail image stays: a
/// change of its noise does not justify another frame of the patient.
void Desk::show_picture_in_space() {
  const auto picture = ultrasound_->picture();
  if (!picture || picture->number == picture_number_ || (has_whole_picture_ && !are_moving_)) return;
  picture_number_ = picture->number;
  has_whole_picture_ = picture->detail == ultrasound::ScanDetail::kFull;
  const volume::RgbImage image = picture->colour.pixels.empty() ? ultrasound::to_rgb(picture->gray) : picture->colour;
  for (PatientView* view : {view_3d_, side_}) {
    if (!view->isVisible()) continue;
    view->set_transducer(picture->X_PT, picture->scan);
    view->set_ultrasound(image, picture->corners_P);
  }
}

}  // namespace trocar::trainer
