#include "pages/work_page.h"

#include <QEvent>
#include <QHBoxLayout>
#include <QStackedWidget>
#include <QVBoxLayout>
#include <algorithm>

#include "core/result.h"
#include "panels/feedback_panel.h"
#include "panels/puncture_panel.h"
#include "parameters/parameter_panel.h"
#include "views/patient/patient_view.h"
#include "views/plots/force_plot.h"
#include "views/plots/time_line.h"
#include "views/ultrasound/ultrasound_view.h"
#include "views/xray/xray_view.h"
#include "workspace/workspace.h"

namespace trocar::trainer {
namespace {

constexpr int kSideColumns = 36;         ///< Average characters.
constexpr int kLeastWorkspace_px = 640;  ///< Two columns of views.

}  // namespace

WorkPage::WorkPage(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("work-page"));
  setFocusPolicy(Qt::StrongFocus);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(0);
  puncture_ = new PuncturePanel;
  feedback_ = new FeedbackPanel;
  side_ = new QStackedWidget;
  side_->addWidget(puncture_);
  side_->addWidget(feedback_);
  workspace_ = new Workspace;
  view_3d_ = workspace_->find<PatientView>("3d");
  ultrasound_ = workspace_->find<UltrasoundView>("ultrasound");
  xray_ = workspace_->find<XrayView>("xray");
  forces_ = workspace_->find<ForcePlot>("forces");
  TROCAR_CHECK(view_3d_ != nullptr && ultrasound_ != nullptr && xray_ != nullptr && forces_ != nullptr);
  time_line_ = new TimeLine;
  time_line_->setObjectName(QStringLiteral("time-line"));
  time_line_->hide();
  parameters_ = new ParameterPanel;
  parameters_->hide();
  auto* column = new QVBoxLayout;
  column->setSpacing(0);
  column->addWidget(workspace_, 1);
  column->addWidget(time_line_);
  row->addWidget(side_);
  row->addLayout(column, 1);
  row->addWidget(parameters_);
  connect(workspace_, &Workspace::layout_chosen, this, &WorkPage::fit);
  connect(puncture_, &PuncturePanel::asked, this, [this] {
    if (side_->isHidden()) toggle_parameters();  // its question must be visible
  });
  fit();
}

/// In a narrow window the tissue panel replaces the side panel, so that the images keep their size.
void WorkPage::fit() {
  const int side_px = std::max(fontMetrics().averageCharWidth() * kSideColumns, puncture_->needed_width());
  if (side_->maximumWidth() != side_px) side_->setFixedWidth(side_px);
  const bool has_room =
      !are_parameters_shown() ||
      width() >= side_px + std::max(kLeastWorkspace_px, workspace_->needed_width()) + parameters_->sizeHint().width();
  if (side_->isHidden() == has_room) side_->setVisible(has_room);
}

void WorkPage::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  fit();
}

void WorkPage::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::FontChange) fit();
}

void WorkPage::show_puncture() {
  side_->setCurrentWidget(puncture_);
  time_line_->hide();
  fit();  // the buttons of another task need another width
}

void WorkPage::show_feedback() {
  side_->setCurrentWidget(feedback_);
  time_line_->show();
}

void WorkPage::set_parameters_locked(bool are_locked) {
  are_parameters_locked_ = are_locked;
  parameters_->setEnabled(!are_locked);
  if (!are_locked || !are_parameters_shown()) return;
  parameters_->hide();
  fit();
}

bool WorkPage::toggle_parameters() {
  if (are_parameters_locked_) return false;
  parameters_->setVisible(!are_parameters_shown());
  fit();
  return true;
}

bool WorkPage::are_parameters_shown() const {
  return !parameters_->isHidden();
}

}  // namespace trocar::trainer
