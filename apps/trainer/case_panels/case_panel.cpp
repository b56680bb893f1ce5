#include "case_panels/case_panel.h"

#include <QVBoxLayout>

namespace trocar::trainer {

CasePanel::CasePanel(case_builder::CaseEditor& editor, QWidget* parent)
    : QWidget(parent), editor_(editor), content_(new QVBoxLayout(this)) {
  content_->setContentsMargins(0, 0, 0, 0);
  content_->setSpacing(8);
}

void CasePanel::show_click(CaseClick /*click*/) {}

std::string CasePanel::click_name() const {
  return {};
}

}  // namespace trocar::trainer
