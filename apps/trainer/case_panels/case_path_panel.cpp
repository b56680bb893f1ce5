// Step 4 of the case builder: entry zone and expert path.
#include <QCoreApplication>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "case_builder/case_edits.h"
#include "case_panels/case_panel.h"
#include "ui_kit/decimal_field.h"
#include "ui_kit/parts.h"

namespace trocar::trainer {
namespace {

class PathPanel final : public CasePanel {
  Q_DECLARE_TR_FUNCTIONS(trocar::trainer::PathPanel)
 public:
  PathPanel(case_builder::CaseEditor& editor, QWidget* parent) : CasePanel(editor, parent) {
    content()->addWidget(make_label(tr("Entry zone"), "heading"));
    add_zone();
    content()->addSpacing(8);
    content()->addWidget(make_label(tr("Expert's path"), "heading"));
    add_path();
    content()->addStretch();
  }

  void refresh() override {
    is_refreshing_ = true;
    const tasks::Task& task = editor_.draft().task;
    zone_text_->setText(task.entry_zone
                            ? tr("Entry points within %1 mm get full points.").arg(task.entry_zone->radius_mm)
                            : tr("No zone: the entry point is compared with the expert's."));
    if (task.entry_zone && !radius_->hasFocus()) radius_->setValue(task.entry_zone->radius_mm);
    no_zone_->setEnabled(task.entry_zone.has_value());
    const anatomy::NeedlePath* path = case_builder::find_expert_path(editor_.draft());
    no_path_->setEnabled(path != nullptr);
    path_text_->setText(
        path != nullptr
            ? tr("%1 mm from the skin to the end position of the tip.").arg(path->line_P.length_mm(), 0, 'f', 0)
            : tr("No path: it is planned each time the case is opened."));
    plan_->setEnabled(editor_.has_patient() && editor_.work() == case_builder::CaseEditor::Work::kNone);
    is_refreshing_ = false;
  }

  void show_click(CaseClick click) override {
    zone_->setChecked(click == CaseClick::kZone);
    entry_->setChecked(click == CaseClick::kEntry);
    tip_->setChecked(click == CaseClick::kTip);
  }

 private:
  QPushButton* make_pick(const char* name, const QString& text, Action action, const QString& does, CaseClick click) {
    QPushButton* button = make_button(name, text, action, does);
    button->setCheckable(true);
    connect(button, &QPushButton::clicked, this,
            [this, click](bool is_on) { Q_EMIT click_requested(is_on ? click : CaseClick::kLook); });
    return button;
  }

  void add_zone() {
    zone_text_ = add_text("case-zone-text");
    auto* row = new QHBoxLayout;
    zone_ = make_pick("case-zone-pick", tr("Click the skin"), Action::kDrawZone,
                      tr("Click the centre of the zone on the skin"), CaseClick::kZone);
    radius_ = new DecimalField;
    radius_->setObjectName(QStringLiteral("case-zone-radius"));
    radius_->setAccessibleName(tr("Radius of the entry zone"));
    radius_->setToolTip(tr("Radius of the entry zone  (up and down keys)"));
    radius_->setRange(1.0, 200.0);
    radius_->setDecimals(1);
    radius_->setValue(20.0);
    radius_->setSuffix(tr(" mm"));
    row->addWidget(zone_);
    row->addWidget(radius_);
    content()->addLayout(row);
    no_zone_ = make_button("case-zone-clear", tr("Remove entry zone"),
                           tr("The entry point is then compared with the expert's path only"));
    content()->addWidget(no_zone_);
    connect(radius_, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, [this](double radius_mm) {
      const auto& zone = editor_.draft().task.entry_zone;
      if (is_refreshing_ || !zone) return;
      editor_.edit(case_builder::set_entry_zone(editor_.draft(), zone->centre_P, radius_mm), "change the entry zone",
                   "zone radius");
    });
    connect(no_zone_, &QPushButton::clicked, this,
            [this] { editor_.edit(case_builder::clear_entry_zone(editor_.draft()), "remove the entry zone"); });
  }

  void add_path() {
    path_text_ = add_text("case-path-text");
    plan_ = make_button("case-plan", tr("Plan automatically"), Action::kPlanPath,
                        tr("The shortest path from the entry zone to the target that keeps all margins"));
    plan_->setProperty("role", "primary");
    content()->addWidget(plan_);
    auto* row = new QHBoxLayout;
    entry_ = make_pick("case-entry-pick", tr("Set entry"), Action::kPickEntry,
                       tr("Click the entry point; drag to move it"), CaseClick::kEntry);
    tip_ = make_pick("case-tip-pick", tr("Set tip"), Action::kPickTip,
                     tr("Click the end position of the tip; drag to move it"), CaseClick::kTip);
    row->addWidget(entry_);
    row->addWidget(tip_);
    content()->addLayout(row);
    no_path_ =
        make_button("case-path-clear", tr("Remove path"), tr("The path is then planned each time the case is opened"));
    content()->addWidget(no_path_);
    connect(plan_, &QPushButton::clicked, this, [this] { editor_.plan_path(); });
    connect(no_path_, &QPushButton::clicked, this,
            [this] { editor_.edit(case_builder::clear_expert_path(editor_.draft()), "remove the path"); });
  }

  QPushButton* zone_ = nullptr;
  QDoubleSpinBox* radius_ = nullptr;
  QPushButton* no_zone_ = nullptr;
  QLabel* zone_text_ = nullptr;
  QLabel* path_text_ = nullptr;
  QPushButton* plan_ = nullptr;
  QPushButton* entry_ = nullptr;
  QPushButton* tip_ = nullptr;
  QPushButton* no_path_ = nullptr;
};

}  // namespace

CasePanel* make_path_panel(case_builder::CaseEditor& editor, QWidget* parent) {
  return new PathPanel(editor, parent);
}

}  // namespace trocar::trainer
