#include "views/ultrasound/ultrasound_view_entry.h"

#include <QToolButton>

#include "ui_kit/parts.h"
#include "views/ultrasound/scanner_view.h"
#include "views/ultrasound/ultrasound_controls.h"
#include "views/ultrasound/ultrasound_view.h"

namespace trocar::trainer {
namespace {

/// In the title of the dock, where it covers nothing of the picture.
QToolButton* make_controls_button() {
  auto* button =
      make_tool_button("show-ultrasound-controls", UltrasoundView::tr("Controls"), Action::kUltrasoundControls);
  button->setShortcut(key_of(Action::kUltrasoundControls));
  button->setCheckable(true);
  button->setFocusPolicy(Qt::NoFocus);
  button->setStyleSheet(QStringLiteral("QToolButton { padding: 0 8px; min-height: 0; }"));
  return button;
}

class UltrasoundViewEntry final : public View {
 public:
  explicit UltrasoundViewEntry(ViewContext& context)
      : view_(new UltrasoundView),
        controls_(new UltrasoundControls(*view_)),
        scanner_(new ScannerView(*view_, *controls_)),
        button_(make_controls_button()) {
    QObject::connect(button_, &QToolButton::toggled, controls_, &QWidget::setVisible);
    context.ultrasound_picture = [view = view_] { return view->picture(); };
  }

  QWidget& widget() override { return *scanner_; }
  QWidget* title_button() override { return button_; }

  bool open(const CaseContext& context) override {
    const cases::OpenCase& open = *context.open;
    later_ = open.later;
    view_->show_patient(open.later->acoustic(), open.flow, open.transducer, open.panorama);
    view_->change_settings([&](UltrasoundSettings& s) {
      s.acquisition.depth_mm = open.probe_depth_mm;
      s.is_panorama = open.panorama != nullptr && open.the_case.task.ultrasound_engine == "panorama";
    });
    return true;
  }

  void show_help(TrainingMode mode) override {
    view_->set_guide_offered(mode != TrainingMode::kExam);
    view_->set_guide_visible(guidance_of(mode) == scene::Guidance::kPath);
  }

  void show_tools(const ToolContext& context) override {
    std::vector<Vec3> metal_P = context.tools->shaft_P;  // the stylet also reflects sound
    if (context.tools->stylet_P) metal_P.push_back(context.tools->stylet_P->b);
    view_->set_needle(metal_P, context.open.the_case.needle.outer_diameter_mm);
    view_->set_throw(context.visible->throw_P, context.visible->notch_P);
    view_->set_motion(context.tools->motion);
    if (context.tools->X_PT) view_->set_transducer_pose(*context.tools->X_PT);
  }

  void take_later_data() override {
    if (later_ && !view_->has_scene()) view_->set_scene(later_->acoustic());
  }

  void update(const FrameContext& frame) override { view_->advance(frame.now_s); }

 private:
  UltrasoundView* view_;
  UltrasoundControls* controls_;
  ScannerView* scanner_;
  QToolButton* button_;
  std::shared_ptr<cases::LaterData> later_;
};

}  // namespace

ViewDescription ultrasound_view_entry() {
  ViewDescription view;
  view.id = QStringLiteral("ultrasound");
  view.title = UltrasoundView::tr("Ultrasound");
  view.make = [](ViewContext& context) { return std::make_unique<UltrasoundViewEntry>(context); };
  return view;
}

}  // namespace trocar::trainer
