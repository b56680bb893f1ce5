#include "case_panels/case_panel.h"

#include <QVBoxLayout>

#include "io/image/image_file.h"
#include "ui_kit/parts.h"

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

QString volume_patterns() {
  QStringList patterns;
  for (const std::string_view ending : io::image_endings()) patterns << QStringLiteral("*") + to_qt(ending);
  return patterns.join(QStringLiteral(" "));
}

}  // namespace trocar::trainer
