// Step 2 of the case builder: check and edit the labels.
#include <QColorDialog>
#include <QComboBox>
#include <QCoreApplication>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QLocale>
#include <QPushButton>
#include <QSlider>
#include <QTableWidget>
#include <QVBoxLayout>
#include <map>
#include <set>

#include "anatomy/label_statistics.h"
#include "anatomy/structure_words.h"
#include "case_builder/case_edits.h"
#include "case_panels/case_panel.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

enum LabelColumn { kLabelName, kLabelTissue, kLabelVolume, kLabelColumns };

class LabelsPanel final : public CasePanel {
  Q_DECLARE_TR_FUNCTIONS(trocar::trainer::LabelsPanel)
 public:
  LabelsPanel(case_builder::CaseEditor& editor, QWidget* parent) : CasePanel(editor, parent) {
    add_opacity();
    add_table();
    add_editor();
    content()->addWidget(make_label(tr("Check box: show the structure in 3D."), "dim"));
  }

  void refresh() override {
    is_refreshing_ = true;
    fill_table();
    show_selected();
    is_refreshing_ = false;
  }

 private:
  void add_opacity() {
    auto* row = new QHBoxLayout;
    row->addWidget(make_label(tr("Overlay"), "dim"));
    auto* slider = new QSlider(Qt::Horizontal);
    slider->setObjectName(QStringLiteral("case-label-opacity"));
    slider->setAccessibleName(tr("Opacity of the labels"));
    slider->setToolTip(tr("Opacity of the labels over the CT  (arrow keys)"));
    slider->setRange(0, 100);
    slider->setValue(40);
    row->addWidget(slider, 1);
    content()->addLayout(row);
    connect(slider, &QSlider::valueChanged, this, [this](int value) { Q_EMIT label_opacity_changed(value / 100.0); });
  }

  void add_table() {
    table_ = new QTableWidget(0, kLabelColumns);
    table_->setObjectName(QStringLiteral("case-label-table"));
    table_->setAccessibleName(tr("Labels"));
    table_->setToolTip(tr("Select a row to edit it below; double-click to go to the label"));
    table_->setHorizontalHeaderLabels({tr("Label"), tr("Tissue"), tr("ml")});
    table_->verticalHeader()->hide();
    table_->verticalHeader()->setDefaultSectionSize(26);
    table_->horizontalHeader()->setSectionResizeMode(kLabelName, QHeaderView::Stretch);
    table_->horizontalHeader()->setSectionResizeMode(kLabelTissue, QHeaderView::Interactive);
    table_->setColumnWidth(kLabelTissue, 80);
    table_->setColumnWidth(kLabelVolume, 48);
    table_->setShowGrid(false);
    table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
    table_->setSelectionBehavior(QAbstractItemView::SelectRows);
    table_->setSelectionMode(QAbstractItemView::SingleSelection);
    content()->addWidget(table_, 1);
    connect(table_, &QTableWidget::itemSelectionChanged, this, [this] {
      if (is_refreshing_) return;
      is_refreshing_ = true;
      show_selected();
      is_refreshing_ = false;
    });
    connect(table_, &QTableWidget::cellDoubleClicked, this, [this](int row, int) { jump_to(row); });
    connect(table_, &QTableWidget::itemChanged, this, [this](const QTableWidgetItem* item) {
      if (is_refreshing_ || item->column() != kLabelName) return;
      const bool is_visible = item->checkState() == Qt::Checked;
      if (is_visible)
        hidden_.erase(id_of(item->row()));
      else
        hidden_.insert(id_of(item->row()));
      Q_EMIT label_visible_changed(item->text(), is_visible);
    });
  }

  void add_editor() {
    auto* row = new QHBoxLayout;
    name_ = new QLineEdit;
    name_->setObjectName(QStringLiteral("case-label-name"));
    name_->setAccessibleName(tr("Name of the label"));
    name_->setToolTip(tr("New name for the selected label  (Enter)"));
    color_ = make_button("case-label-color", tr("Colour…"), tr("New colour for the selected label"));
    row->addWidget(name_, 1);
    row->addWidget(color_);
    content()->addLayout(row);
    tissue_ = new QComboBox;
    tissue_->setObjectName(QStringLiteral("case-label-tissue"));
    tissue_->setAccessibleName(tr("Tissue of the label"));
    tissue_->setToolTip(tr("Mechanical tissue of the selected label"));
    for (const anatomy::TissueParams& tissue : editor_.tissues().tissues)
      if (tissue.name != "air") tissue_->addItem(shown(anatomy::structure_words(tissue.name)), to_qt(tissue.name));
    content()->addWidget(tissue_);
    connect(name_, &QLineEdit::editingFinished, this, [this] {
      const anatomy::Label* label = selected();
      if (is_refreshing_ || label == nullptr || name_->text() == to_qt(label->name)) return;
      if (!editor_.edit(case_builder::rename_label(editor_.draft(), label->id, to_std(name_->text().trimmed())),
                        "rename a label")) {
        name_->setText(to_qt(label->name));
      }
    });
    connect(tissue_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this] {
      const anatomy::Label* label = selected();
      if (is_refreshing_ || label == nullptr || tissue_->currentIndex() < 0) return;
      editor_.edit(
          case_builder::set_label_tissue(editor_.draft(), label->id, to_std(tissue_->currentData().toString())),
          "change a tissue");
    });
    connect(color_, &QPushButton::clicked, this, [this] { choose_color(); });
  }

  void choose_color() {
    const anatomy::Label* label = selected();
    if (label == nullptr) return;
    const std::uint8_t id = label->id;
    const QColor before(label->color[0], label->color[1], label->color[2]);
    const QColor color = QColorDialog::getColor(before, this, tr("Colour of %1").arg(to_qt(label->name)));
    if (!color.isValid()) return;
    editor_.edit(
        case_builder::set_label_color(editor_.draft(), id,
                                      {static_cast<std::uint8_t>(color.red()), static_cast<std::uint8_t>(color.green()),
                                       static_cast<std::uint8_t>(color.blue())}),
        "change a colour");
  }

  void fill_table() {
    const std::vector<anatomy::Label>& labels = editor_.draft().label_table.labels;
    table_->setRowCount(static_cast<int>(labels.size()));
    std::map<std::uint8_t, double> volumes;
    if (editor_.has_patient())
      for (const anatomy::LabelStatistics& s : editor_.draft().imported->statistics) volumes[s.id] = s.volume_ml;
    for (std::size_t n = 0; n < labels.size(); ++n) {
      const anatomy::Label& label = labels[n];
      const int row = static_cast<int>(n);
      QTableWidgetItem* name = item(row, kLabelName);
      name->setText(to_qt(label.name));
      name->setData(Qt::UserRole, label.id);
      name->setData(Qt::DecorationRole, QColor(label.color[0], label.color[1], label.color[2]));
      name->setCheckState(hidden_.count(label.id) != 0 ? Qt::Unchecked : Qt::Checked);
      name->setToolTip(label.is_derived ? tr("Derived: made by the program, not in the segmentation") : QString());
      QFont font = name->font();
      font.setItalic(label.is_derived);
      name->setFont(font);
      item(row, kLabelTissue)->setText(shown(anatomy::structure_words(label.tissue)));
      QTableWidgetItem* volume = item(row, kLabelVolume);
      volume->setText(QLocale().toString(volumes[label.id], 'f', volumes[label.id] < 10.0 ? 1 : 0));
      volume->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
    }
  }

  QTableWidgetItem* item(int row, int column) {
    if (table_->item(row, column) == nullptr) table_->setItem(row, column, new QTableWidgetItem);
    return table_->item(row, column);
  }

  std::uint8_t id_of(int row) const {
    return static_cast<std::uint8_t>(table_->item(row, kLabelName)->data(Qt::UserRole).toInt());
  }

  const anatomy::Label* selected() const {
    const int row = table_->currentRow();
    if (row < 0 || table_->item(row, kLabelName) == nullptr) return nullptr;
    return editor_.draft().label_table.find(id_of(row));
  }

  void show_selected() {
    const anatomy::Label* label = selected();
    for (QWidget* widget : std::initializer_list<QWidget*>{name_, tissue_, color_})
      widget->setEnabled(label != nullptr);
    if (label == nullptr) return name_->clear();
    if (!name_->hasFocus()) name_->setText(to_qt(label->name));
    tissue_->setCurrentIndex(tissue_->findData(to_qt(label->tissue)));
  }

  void jump_to(int row) {
    const std::uint8_t id = id_of(row);
    for (const anatomy::LabelStatistics& s : editor_.draft().imported->statistics)
      if (s.id == id && s.voxels > 0) Q_EMIT place_requested(s.centroid_P);
  }

  QTableWidget* table_ = nullptr;
  QLineEdit* name_ = nullptr;
  QComboBox* tissue_ = nullptr;
  QPushButton* color_ = nullptr;
  std::set<std::uint8_t> hidden_;
};

}  // namespace

CasePanel* make_labels_panel(case_builder::CaseEditor& editor, QWidget* parent) {
  return new LabelsPanel(editor, parent);
}

}  // namespace trocar::trainer
