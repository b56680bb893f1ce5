// Step 3 of the case builder: target and structures at risk.
#include <QComboBox>
#include <QCoreApplication>
#include <QDoubleSpinBox>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QTabWidget>
#include <QTableWidget>
#include <QVBoxLayout>

#include "anatomy/structure_words.h"
#include "case_builder/case_edits.h"
#include "case_panels/case_landmarks.h"
#include "case_panels/case_panel.h"
#include "ui_kit/decimal_field.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

enum RiskColumn { kRiskStructure, kRiskMargin, kRiskHarm, kRiskColumns };

constexpr int kHarmChoices = static_cast<int>(tasks::Harm::kCritical) + 2;

/// Of an entry of the list: the first one is "as in the table of harm".
std::optional<tasks::Harm> harm_of(int entry) {
  return entry > 0 ? std::optional(static_cast<tasks::Harm>(entry - 1)) : std::nullopt;
}

QString harm_text(const std::optional<tasks::Harm>& harm) {
  return harm ? shown(tasks::to_string(*harm)) : CasePanel::tr("usual");
}

QString name_of(const tasks::RiskStructure& risk) {
  return to_qt(risk.tissue.empty() ? risk.label : risk.tissue);
}

class TargetPanel final : public CasePanel {
  Q_DECLARE_TR_FUNCTIONS(trocar::trainer::TargetPanel)
 public:
  TargetPanel(case_builder::CaseEditor& editor, QWidget* parent) : CasePanel(editor, parent) {
    add_template();
    add_target();
    auto* tabs = new QTabWidget;
    tabs->setObjectName(QStringLiteral("case-target-tabs"));
    tabs->addTab(make_risks(), tr("Structures at risk"));
    tabs->addTab(make_landmarks(), tr("Landmarks"));
    content()->addWidget(tabs, 1);
  }

  void refresh() override {
    is_refreshing_ = true;
    const case_builder::CaseDraft& draft = editor_.draft();
    template_->setCurrentIndex(template_->findData(to_qt(draft.base.name)));
    fill_labels();
    target_->setCurrentIndex(std::max(0, target_->findData(to_qt(draft.task.target_label))));
    const auto target_P = case_builder::find_target_point(draft);
    where_->setText(!target_P             ? tr("no target yet")
                    : draft.task.target_P ? tr("point %1").arg(place(*target_P))
                                          : tr("centre of the label, %1").arg(place(*target_P)));
    fill_table();
    landmarks_->refresh();
    is_refreshing_ = false;
  }

  void show_click(CaseClick click) override {
    pick_->setChecked(click == CaseClick::kTarget);
    landmarks_->show_picking(click == CaseClick::kLandmark);
  }

  std::string click_name() const override { return landmarks_->name(); }

 private:
  static QString place(const Vec3& p_P) {
    return QStringLiteral("(%L1, %L2, %L3) mm").arg(p_P.x(), 0, 'f', 0).arg(p_P.y(), 0, 'f', 0).arg(p_P.z(), 0, 'f', 0);
  }

  QComboBox* add_box(const char* name, const QString& title, const QString& tooltip) {
    content()->addWidget(make_label(title, "dim"));
    QComboBox* box = make_wide_box(name, title, tooltip);
    content()->addWidget(box);
    return box;
  }

  void add_template() {
    template_ =
        add_box("case-template", tr("Task, as a template"), tr("Limits, scoring and risks are copied from this task"));
    for (const tasks::Task& task : editor_.templates()) template_->addItem(shown(task.title), to_qt(task.name));
    connect(template_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this](int row) {
      if (is_refreshing_ || row < 0) return;
      editor_.edit(case_builder::use_template(editor_.draft(), editor_.templates()[static_cast<std::size_t>(row)]),
                   "choose a template");
    });
  }

  void add_target() {
    target_ = add_box("case-target-label", tr("Target"), tr("The target structure"));
    connect(target_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this](int row) {
      if (is_refreshing_ || row < 0) return;
      editor_.edit(case_builder::set_target_label(editor_.draft(), to_std(target_->currentData().toString())),
                   "choose the target");
    });
    pick_ = make_button("case-target-pick", tr("Click a point"), Action::kPickTarget);
    pick_->setCheckable(true);
    content()->addWidget(pick_);
    where_ = make_label({}, "dim");
    content()->addWidget(where_);
    connect(pick_, &QPushButton::clicked, this,
            [this](bool is_on) { Q_EMIT click_requested(is_on ? CaseClick::kTarget : CaseClick::kLook); });
  }

  QWidget* make_risks() {
    auto* risks = new QWidget;
    auto* column = new QVBoxLayout(risks);
    column->setContentsMargins(0, 8, 0, 0);
    column->setSpacing(8);
    add_table(*column);
    add_editor(*column);
    return risks;
  }

  QWidget* make_landmarks() {
    landmarks_ = new CaseLandmarks(editor_);
    connect(landmarks_, &CaseLandmarks::picking_requested, this,
            [this](bool is_on) { Q_EMIT click_requested(is_on ? CaseClick::kLandmark : CaseClick::kLook); });
    connect(landmarks_, &CaseLandmarks::name_changed, this, &CasePanel::click_name_changed);
    connect(landmarks_, &CaseLandmarks::place_requested, this, &CasePanel::place_requested);
    return landmarks_;
  }

  void add_table(QVBoxLayout& column) {
    table_ = new QTableWidget(0, kRiskColumns);
    table_->setObjectName(QStringLiteral("case-risk-table"));
    table_->setAccessibleName(tr("Risk structures"));
    table_->setToolTip(tr("Select a row to change it below"));
    table_->setHorizontalHeaderLabels({tr("Structure"), tr("Margin"), tr("Harm")});
    table_->verticalHeader()->hide();
    table_->verticalHeader()->setDefaultSectionSize(26);
    table_->horizontalHeader()->setSectionResizeMode(kRiskStructure, QHeaderView::Stretch);
    table_->setColumnWidth(kRiskMargin, 72);
    table_->setColumnWidth(kRiskHarm, 76);
    table_->setShowGrid(false);
    table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
    table_->setSelectionBehavior(QAbstractItemView::SelectRows);
    table_->setSelectionMode(QAbstractItemView::SingleSelection);
    column.addWidget(table_, 1);
    connect(table_, &QTableWidget::itemSelectionChanged, this, [this] { show_selected(); });
  }

  QDoubleSpinBox* make_number(const char* name, const QString& title, double most, const QString& unit) {
    auto* number = new DecimalField;
    number->setObjectName(QString::fromLatin1(name));
    number->setAccessibleName(title);
    number->setToolTip(title + tr("  (up and down keys)"));
    number->setRange(0.0, most);
    number->setDecimals(1);
    number->setSuffix(unit);
    connect(number, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, [this] { change_selected(); });
    return number;
  }

  void add_editor(QVBoxLayout& column) {
    auto* numbers = new QHBoxLayout;
    margin_ = make_number("case-risk-margin", tr("Required margin of a path"), 50.0, tr(" mm"));
    harm_ = new QComboBox;
    harm_->setMinimumContentsLength(6);
    harm_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    harm_->setObjectName(QStringLiteral("case-risk-harm"));
    harm_->setAccessibleName(tr("Harm"));
    harm_->setToolTip(tr("What it means if the needle goes into it"));
    for (int n = 0; n < kHarmChoices; ++n) harm_->addItem(harm_text(harm_of(n)));
    connect(harm_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this] { change_selected(); });
    numbers->addWidget(margin_);
    numbers->addWidget(harm_, 1);
    column.addLayout(numbers);
    auto* row = new QHBoxLayout;
    structure_ = new QComboBox;
    structure_->setObjectName(QStringLiteral("case-risk-structure"));
    structure_->setAccessibleName(tr("Structure to add"));
    structure_->setToolTip(tr("A tissue, or one label of this patient"));
    structure_->setMinimumContentsLength(4);
    structure_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    QPushButton* add = make_button("case-risk-add", tr("Add"), tr("Add this structure to the list"));
    QPushButton* remove = make_button("case-risk-remove", tr("Remove"), tr("Remove the selected row from the list"));
    row->addWidget(structure_, 1);
    row->addWidget(add);
    row->addWidget(remove);
    column.addLayout(row);
    connect(add, &QPushButton::clicked, this, [this] { add_risk(); });
    connect(remove, &QPushButton::clicked, this, [this] {
      if (table_->currentRow() >= 0)
        editor_.edit(case_builder::remove_risk(editor_.draft(), static_cast<std::size_t>(table_->currentRow())),
                     "remove a risk");
    });
  }

  void add_risk() {
    const std::string name = to_std(structure_->currentData().toString());
    if (name.empty()) return;
    tasks::RiskStructure risk;
    (editor_.draft().label_table.find(std::string_view(name)) != nullptr ? risk.label : risk.tissue) = name;
    editor_.edit(case_builder::set_risk(editor_.draft(), risk), "add a risk");
  }

  const tasks::RiskStructure* selected() const {
    const int row = table_->currentRow();
    const auto& risks = editor_.draft().task.risks;
    return row >= 0 && row < static_cast<int>(risks.size()) ? &risks[static_cast<std::size_t>(row)] : nullptr;
  }

  void show_selected() {
    const tasks::RiskStructure* risk = selected();
    margin_->setEnabled(risk != nullptr);
    harm_->setEnabled(risk != nullptr);
    if (risk == nullptr) return;
    const bool was_refreshing = is_refreshing_;
    is_refreshing_ = true;
    margin_->setValue(risk->margin_mm);
    harm_->setCurrentIndex(risk->harm ? static_cast<int>(*risk->harm) + 1 : 0);
    is_refreshing_ = was_refreshing;
  }

  void change_selected() {
    const tasks::RiskStructure* risk = selected();
    if (is_refreshing_ || risk == nullptr) return;
    tasks::RiskStructure next = *risk;
    next.margin_mm = margin_->value();
    next.harm = harm_of(harm_->currentIndex());
    editor_.edit(case_builder::set_risk(editor_.draft(), next), "change a risk", "risk " + risk->tissue + risk->label);
  }

  /// Labels of the patient; the first entry selects the tissues of the template.
  void fill_labels() {
    QStringList names;
    for (const anatomy::Label& label : editor_.draft().label_table.labels) names << to_qt(label.name);
    if (names == shown_labels_ && target_->count() > 0) return;
    shown_labels_ = names;
    target_->clear();
    target_->addItem(tr("as in the task"), QString());
    structure_->clear();
    for (const anatomy::TissueParams& tissue : editor_.tissues().tissues)
      if (tissue.name != "air" && tissue.name != "skin")
        structure_->addItem(tr("all %1").arg(shown(anatomy::structure_words(tissue.name))), to_qt(tissue.name));
    for (const QString& name : names) {
      target_->addItem(name, name);
      structure_->addItem(name, name);
    }
  }

  void fill_table() {
    const auto& risks = editor_.draft().task.risks;
    table_->setRowCount(static_cast<int>(risks.size()));
    for (std::size_t n = 0; n < risks.size(); ++n) {
      const QStringList texts{name_of(risks[n]), tr("%1 mm").arg(risks[n].margin_mm), harm_text(risks[n].harm)};
      for (int column = 0; column < kRiskColumns; ++column) {
        QTableWidgetItem* cell = table_->item(static_cast<int>(n), column);
        if (cell == nullptr) table_->setItem(static_cast<int>(n), column, cell = new QTableWidgetItem);
        cell->setText(texts[column]);
        if (column != kRiskStructure) cell->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
      }
    }
    show_selected();
  }

  QComboBox* template_ = nullptr;
  QComboBox* target_ = nullptr;
  QPushButton* pick_ = nullptr;
  CaseLandmarks* landmarks_ = nullptr;
  QLabel* where_ = nullptr;
  QTableWidget* table_ = nullptr;
  QDoubleSpinBox* margin_ = nullptr;
  QComboBox* harm_ = nullptr;
  QComboBox* structure_ = nullptr;
  QStringList shown_labels_;
};

}  // namespace

CasePanel* make_target_panel(case_builder::CaseEditor& editor, QWidget* parent) {
  return new TargetPanel(editor, parent);
}

}  // namespace trocar::trainer
