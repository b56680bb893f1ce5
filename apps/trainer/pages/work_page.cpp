#include "pages/work_page.h"

#include <QHBoxLayout>
#include <QStackedWidget>
#include <QVBoxLayout>

#include "desk/desk.h"
#include "panels/feedback_panel.h"
#include "panels/parameter_panel.h"
#include "panels/puncture_panel.h"
#include "views/time_line.h"

namespace trocar::trainer {
namespace {

constexpr int kSideColumns = 34;  // average characters

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
  side_->setFixedWidth(fontMetrics().averageCharWidth() * kSideColumns);
  desk_ = new Desk;
  time_line_ = new TimeLine;
  time_line_->setObjectName(QStringLiteral("time-line"));
  time_line_->hide();
  parameters_ = new ParameterPanel;
  parameters_->hide();
  auto* column = new QVBoxLayout;
  column->setSpacing(0);
  column->addWidget(desk_, 1);
  column->addWidget(time_line_);
  row->addWidget(side_);
  row->addLayout(column, 1);
  row->addWidget(parameters_);
}

void WorkPage::show_puncture() {
  side_->setCurrentWidget(puncture_);
  time_line_->hide();
}

void WorkPage::show_feedback() {
  side_->setCurrentWidget(feedback_);
  time_line_->show();
}

void WorkPage::toggle_parameters() {
  parameters_->setVisible(!parameters_->isVisible());
}

bool WorkPage::are_parameters_shown() const {
  return parameters_->isVisible();
}

}  // namespace trocar::trainer
