#include "case_panels/case_panel.h"

#include <QComboBox>
#include <QLabel>
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

QLabel* CasePanel::add_text(const char* object_name) {
  QLabel* label = make_label({}, "dim");
  label->setObjectName(QString::fromLatin1(object_name));
  label->setWordWrap(true);
  content()->addWidget(label);
  return label;
}

QComboBox* CasePanel::make_wide_box(const char* object_name, const QString& title, const QString& tooltip) {
  auto* box = new QComboBox;
  box->setObjectName(QString::fromLatin1(object_name));
  box->setAccessibleName(title);
  box->setToolTip(tooltip);
  box->setMinimumContentsLength(8);
  box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  return box;
}

QString volume_patterns() {
  QStringList patterns;
  for (const std::string_view ending : io::image_endings()) patterns << QStringLiteral("*") + to_qt(ending);
  return patterns.join(QStringLiteral(" "));
}

}  // namespace trocar::trainer
