// Step 5 of the case builder: predicted force along the expert's path.
#include <QCoreApplication>
#include <QHeaderView>
#include <QLabel>
#include <QLocale>
#include <QTableWidget>
#include <QVBoxLayout>

#include "anatomy/structure_words.h"
#include "case_panels/case_panel.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"
#include "views/plots/force_plot.h"

namespace trocar::trainer {
namespace {

class ForcePanel final : public CasePanel {
  Q_DECLARE_TR_FUNCTIONS(trocar::trainer::ForcePanel)
 public:
  ForcePanel(case_builder::CaseEditor& editor, QWidget* parent) : CasePanel(editor, parent) {
    text_ = make_label({}, "dim");
    text_->setObjectName(QStringLiteral("case-force-text"));
    text_->setWordWrap(true);
    content()->addWidget(text_);
    plot_ = new ForcePlot;
    plot_->setMinimumHeight(220);
    content()->addWidget(plot_, 3);
    table_ = new QTableWidget(0, 3);
    table_->setObjectName(QStringLiteral("case-force-events"));
    table_->setAccessibleName(tr("Punctured layers"));
    table_->setToolTip(tr("Position and force of each puncture; double-click to go there"));
    table_->setHorizontalHeaderLabels({tr("Gives way"), tr("at mm"), tr("N")});
    table_->verticalHeader()->hide();
    table_->verticalHeader()->setDefaultSectionSize(26);
    table_->horizontalHeader()->setSectionResizeMode(0, QHeaderView::Stretch);
    table_->setColumnWidth(1, 68);
    table_->setColumnWidth(2, 60);
    table_->setShowGrid(false);
    table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
    table_->setSelectionBehavior(QAbstractItemView::SelectRows);
    content()->addWidget(table_, 2);
    connect(table_, &QTableWidget::cellDoubleClicked, this, [this](int row, int) { jump_to(row); });
  }

  void refresh() override {
    const auto& preview = editor_.preview();
    if (!preview) {
      text_->setText(!editor_.has_patient() ? tr("Import a patient first.") : shown(editor_.preview_error()));
      plot_->set_predicted({});
      plot_->set_bands({});
      table_->setRowCount(0);
      return;
    }
    text_->setText(tr("At 10 mm/s along the path; at most %1 N.").arg(preview->highest_n, 0, 'f', 1));
    std::vector<QPointF> curve;
    for (const cases::CurvePoint& point : preview->curve)
      if (curve.empty() || point.tip_mm > curve.back().x()) curve.emplace_back(point.tip_mm, point.force_n);
    plot_->set_predicted(std::move(curve));
    std::vector<ForcePlot::Band> bands;
    for (const cases::PathPiece& piece : preview->pieces)
      bands.push_back({piece.from_mm, piece.to_mm, shown(anatomy::structure_words(piece.name)), color_of(piece.name)});
    plot_->set_bands(std::move(bands));
    table_->setRowCount(static_cast<int>(preview->events.size()));
    for (std::size_t n = 0; n < preview->events.size(); ++n) {
      const cases::CurveEvent& event = preview->events[n];
      const QStringList texts{shown(anatomy::structure_words(event.layer)), QLocale().toString(event.tip_mm, 'f', 1),
                              QLocale().toString(event.peak_n, 'f', 2)};
      for (int column = 0; column < 3; ++column) {
        auto* cell = new QTableWidgetItem(texts[column]);
        if (column > 0) cell->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
        table_->setItem(static_cast<int>(n), column, cell);
      }
    }
  }

 private:
  QColor color_of(const std::string& name) const {
    const anatomy::Label* label = editor_.draft().label_table.find(std::string_view(name));
    return label != nullptr ? QColor(label->color[0], label->color[1], label->color[2]) : QColor(200, 170, 150);
  }

  void jump_to(int row) {
    const anatomy::NeedlePath* path = case_builder::find_expert_path(editor_.draft());
    const auto& preview = editor_.preview();
    if (path == nullptr || !preview || row >= static_cast<int>(preview->events.size())) return;
    Q_EMIT place_requested(path->line_P.a +
                           preview->events[static_cast<std::size_t>(row)].tip_mm * path->line_P.direction());
  }

  QLabel* text_ = nullptr;
  ForcePlot* plot_ = nullptr;
  QTableWidget* table_ = nullptr;
};

}  // namespace

CasePanel* make_force_panel(case_builder::CaseEditor& editor, QWidget* parent) {
  return new ForcePanel(editor, parent);
}

}  // namespace trocar::trainer
