#include "panels/expert_path_list.h"

#include <QCheckBox>
#include <QGridLayout>
#include <QLabel>
#include <QLocale>
#include <QPainter>
#include <QVBoxLayout>

#include "ui_kit/parts.h"
#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

/// A piece of the line as the views draw it.
QPixmap sample_of(bool is_nearest, const QFontMetrics& metrics) {
  QPixmap sample(metrics.height() * 3 / 2, metrics.height());
  sample.fill(Qt::transparent);
  QPainter painter(&sample);
  QColor faint = theme().text;
  faint.setAlphaF(0.8F);
  painter.setPen(is_nearest ? QPen(theme().path, 2.5) : QPen(faint, 1.5, Qt::DashLine));
  painter.drawLine(0, sample.height() / 2, sample.width(), sample.height() / 2);
  return sample;
}

}  // namespace

ExpertPathList::ExpertPathList(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("expert-paths"));
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(4);
  column->addWidget(make_label(tr("Expert paths"), "heading"));
  auto* caption = make_label(tr("Distance of the tip's path from each, mm"), "dim");
  caption->setWordWrap(true);
  column->addWidget(caption);
  grid_ = new QGridLayout;
  grid_->setHorizontalSpacing(5);
  grid_->setVerticalSpacing(3);
  grid_->setColumnStretch(1, 1);
  column->addLayout(grid_);
  others_ = new QCheckBox(tr("Show the other paths"));
  others_->setObjectName(QStringLiteral("show-expert-paths"));
  others_->setChecked(true);
  column->addWidget(others_);
  connect(others_, &QCheckBox::toggled, this, &ExpertPathList::others_toggled);
  hide();
}

void ExpertPathList::show_rows(const std::vector<Row>& rows) {
  clear_layout(*grid_);
  const auto add = [&](const QString& text, int line, int place, bool is_dim) {
    auto* label = make_label(text, is_dim ? "dim" : "");
    if (place > 1) label->setAlignment(Qt::AlignRight | Qt::AlignTop);
    grid_->addWidget(label, line, place);
    return label;
  };
  add(tr("Fréchet"), 0, 2, true)->setToolTip(tr("Fréchet distance between the path of the tip and the expert path"));
  add(tr("Hausdorff"), 0, 3, true)->setToolTip(tr("The largest distance of a point of one from the other"));
  int line = 1;
  for (const Row& row : rows) {
    auto* sample = new QLabel;
    sample->setPixmap(sample_of(row.is_nearest, fontMetrics()));
    grid_->addWidget(sample, line, 0, Qt::AlignTop);
    auto* name = add(row.is_nearest ? tr("%1 (nearest)").arg(row.name) : row.name, line, 1, !row.is_nearest);
    name->setObjectName(QStringLiteral("expert-path-%1").arg(line));
    name->setWordWrap(true);
    add(QLocale().toString(row.frechet_mm, 'f', 1), line, 2, !row.is_nearest);
    add(QLocale().toString(row.hausdorff_mm, 'f', 1), line, 3, !row.is_nearest);
    ++line;
  }
  others_->setVisible(rows.size() > 1);
  setVisible(!rows.empty());
}

bool ExpertPathList::are_others_shown() const {
  return others_->isChecked();
}

}  // namespace trocar::trainer
