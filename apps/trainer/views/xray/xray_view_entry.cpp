#include "views/xray/xray_view_entry.h"

#include <QHBoxLayout>
#include <QToolButton>

#include "anatomy/label_statistics.h"
#include "ui_kit/parts.h"
#include "views/xray/xray_controls.h"
#include "views/xray/xray_view.h"

namespace trocar::trainer {
namespace {

/// Middle of the task's organ, which tells less than the target; else the middle of the volume.
Vec3 begin_at_P(const cases::OpenCase& open) {
  const anatomy::VirtualPatient& patient = *open.the_case.patient;
  for (const anatomy::LabelStatistics& label : anatomy::label_statistics(patient))
    if (const anatomy::Label* found = patient.label_table.find(label.id);
        found != nullptr && label.voxels > 0 && is_organ(open.the_case.task, *found))
      return label.centroid_P;
  return patient.ct.geometry.to_mm(0.5 * (volume::to_vec3(patient.ct.geometry.size) - Vec3::Ones()));
}

class XrayViewEntry final : public View {
 public:
  XrayViewEntry() : room_(new QWidget), view_(new XrayView), controls_(new XrayControls(*view_)) {
    auto* row = new QHBoxLayout(room_);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(0);
    row->addWidget(view_, 1);
    row->addWidget(controls_);
    controls_->hide();
    button_ = make_tool_button("show-xray-controls", XrayView::tr("Controls"),
                               XrayView::tr("Pedal, C-arm and image controls next to the X-ray image"));
    button_->setCheckable(true);
    button_->setFocusPolicy(Qt::NoFocus);
    button_->setStyleSheet(QStringLiteral("QToolButton { padding: 0 8px; min-height: 0; }"));
    QObject::connect(button_, &QToolButton::toggled, controls_, &QWidget::setVisible);
  }

  QWidget& widget() override { return *room_; }
  QWidget* title_button() override { return button_; }

  bool open(const CaseContext& context) override {
    const cases::OpenCase& open = *context.open;
    is_needed_ = open.the_case.task.guidance == tasks::ImagingModality::kXray;
    view_->show_patient(open.the_case.patient, open.the_case.needle,
                        [open = context.open] { return begin_at_P(*open); });
    return true;
  }
  /// A task under fluoroscopy prepares its images during the briefing, others when the view is shown.
  void take_later_data() override {
    if (is_needed_) view_->prepare();
  }
  void show_tools(const ToolContext& context) override {
    view_->set_motion(context.tools->motion);
    view_->set_needle(context.tools->shaft_P);
    view_->set_wire(context.tools->wire_P);
  }
  void update(const FrameContext& frame) override { view_->advance(frame.now_s); }

 private:
  QWidget* room_;
  XrayView* view_;
  XrayControls* controls_;
  QToolButton* button_ = nullptr;
  bool is_needed_ = false;
};

}  // namespace

ViewDescription xray_view_entry() {
  ViewDescription view;
  view.id = QStringLiteral("xray");
  view.title = XrayView::tr("X-ray");
  view.toggled_by = Action::kXrayView;
  view.make = [](ViewContext&) { return std::make_unique<XrayViewEntry>(); };
  return view;
}

}  // namespace trocar::trainer
