// Step 6 of the case builder: a recorded ultrasound volume and its registration to the CT.
#include <QCheckBox>
#include <QComboBox>
#include <QCoreApplication>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSlider>
#include <QVBoxLayout>

#include "case_builder/ultrasound.h"
#include "case_panels/case_landmark_pairs.h"
#include "case_panels/case_panel.h"
#include "ui_kit/parts.h"

namespace trocar::trainer {
namespace {

using case_builder::CaseEditor;
using case_builder::RegistrationStart;

class UltrasoundPanel final : public CasePanel {
  Q_DECLARE_TR_FUNCTIONS(trocar::trainer::UltrasoundPanel)
 public:
  UltrasoundPanel(CaseEditor& editor, QWidget* parent) : CasePanel(editor, parent) {
    add_file();
    content()->addWidget(make_label(tr("Landmark pairs"), "heading"));
    add_pairs();
    content()->addWidget(make_label(tr("Registration"), "heading"));
    add_registration();
    content()->addWidget(make_label(tr("Comparison"), "heading"));
    add_comparison();
    content()->addStretch();
  }

  void refresh() override {
    is_refreshing_ = true;
    const case_builder::CaseDraft& draft = editor_.draft();
    const bool is_idle = editor_.work() == CaseEditor::Work::kNone;
    const bool has_volume = draft.ultrasound != nullptr;
    read_->setEnabled(editor_.has_patient() && is_idle);
    remove_->setEnabled(has_volume && is_idle);
    volume_text_->setText(describe(draft));
    pairs_->refresh();
    start_->setEnabled(has_volume);
    register_->setEnabled(has_volume && is_idle && (draft.placement || start() != RegistrationStart::kCurrent));
    pose_text_->setText(describe_pose(draft));
    is_used_->setEnabled(draft.placement.has_value());
    is_used_->setChecked(uses_recorded_ultrasound(draft));
    for (QWidget* widget : {static_cast<QWidget*>(fusion_), static_cast<QWidget*>(share_)})
      widget->setEnabled(draft.placement.has_value());
    is_refreshing_ = false;
  }

  void show_click(CaseClick click) override { pairs_->show_picking(click == CaseClick::kPair); }
  std::string click_name() const override { return pairs_->name(); }

 private:
  void add_file() {
    QLabel* kind = make_label(tr("A sweep or a stitched panorama"), "dim");
    kind->setWordWrap(true);
    content()->addWidget(kind);
    file_ = new QLineEdit;
    file_->setObjectName(QStringLiteral("case-us-file"));
    file_->setAccessibleName(tr("Ultrasound volume"));
    file_->setToolTip(tr("Gray levels 0 to 255: NRRD, NIfTI or MHA  (Enter reads it)"));
    file_->setPlaceholderText(QStringLiteral("panorama.nrrd"));
    QPushButton* choose = make_button("case-us-choose", tr("File…"), tr("Select the file"));
    content()->addWidget(file_);
    axis_ = make_wide_box("case-us-axis", tr("Beam direction"),
                          tr("Direction of sound along the volume's axes; the header's beams are used by default"));
    axis_->addItem(tr("Beams of the header, or along +y"), QString());
    for (const char* axis : {"+x", "-x", "+y", "-y", "+z", "-z"})
      axis_->addItem(tr("Beams along %1").arg(QLatin1String(axis)), QString::fromLatin1(axis));
    content()->addWidget(axis_);
    auto* actions = new QHBoxLayout;
    read_ = make_button("case-us-read", tr("Read"), tr("Read the volume; it replaces another one"));
    remove_ = make_button("case-us-remove", tr("Remove"), tr("Remove the ultrasound from the case"));
    actions->addWidget(choose);
    actions->addWidget(read_);
    actions->addWidget(remove_);
    content()->addLayout(actions);
    volume_text_ = add_text("case-us-text");
    connect(choose, &QPushButton::clicked, this, [this] {
      const QString path = QFileDialog::getOpenFileName(this, tr("Ultrasound volume"), {}, volume_patterns());
      if (path.isEmpty()) return;
      file_->setText(path);
      read();
    });
    connect(read_, &QPushButton::clicked, this, [this] { read(); });
    connect(file_, &QLineEdit::returnPressed, this, [this] { read(); });
    connect(remove_, &QPushButton::clicked, this,
            [this] { editor_.edit(case_builder::remove_ultrasound(editor_.draft()), "remove the ultrasound"); });
  }

  void read() { editor_.read_ultrasound({to_std(file_->text().trimmed()), to_std(axis_->currentData().toString())}); }

  void add_pairs() {
    pairs_ = new CaseLandmarkPairs(editor_);
    connect(pairs_, &CaseLandmarkPairs::picking_requested, this,
            [this](bool is_on) { Q_EMIT click_requested(is_on ? CaseClick::kPair : CaseClick::kLook); });
    connect(pairs_, &CaseLandmarkPairs::name_changed, this, &CasePanel::click_name_changed);
    connect(pairs_, &CaseLandmarkPairs::place_requested, this, &CasePanel::place_requested);
    connect(pairs_, &CaseLandmarkPairs::ultrasound_place_requested, this, &CasePanel::ultrasound_place_requested);
    content()->addWidget(pairs_);
  }

  RegistrationStart start() const { return static_cast<RegistrationStart>(start_->currentData().toInt()); }

  void add_registration() {
    start_ = make_wide_box("case-us-start", tr("Start of the registration"), tr("First pose of the optimisation"));
    start_->addItem(tr("Start: present pose"), static_cast<int>(RegistrationStart::kCurrent));
    start_->addItem(tr("Start: the volumes share a frame"), static_cast<int>(RegistrationStart::kHeader));
    start_->addItem(tr("Start: search on the skin"), static_cast<int>(RegistrationStart::kSearch));
    connect(start_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this] {
      if (!is_refreshing_) refresh();
    });
    content()->addWidget(start_);
    register_ = make_button("case-us-register", tr("Register"),
                            tr("Optimise the pose by mutual information; a result of low confidence is refused"));
    register_->setProperty("role", "primary");
    connect(register_, &QPushButton::clicked, this, [this] { editor_.register_ultrasound(start()); });
    content()->addWidget(register_);
    pose_text_ = add_text("case-us-pose");
  }

  void add_comparison() {
    auto* row = new QHBoxLayout;
    fusion_ =
        make_wide_box("case-us-fusion", tr("Comparison"), tr("How the ultrasound is drawn in the slices of the CT"));
    fusion_->addItem(tr("Blend"), static_cast<int>(slices::FusionKind::kBlend));
    fusion_->addItem(tr("Checkerboard"), static_cast<int>(slices::FusionKind::kCheckerboard));
    fusion_->addItem(tr("Off"), static_cast<int>(slices::FusionKind::kOff));
    share_ = new QSlider(Qt::Horizontal);
    share_->setObjectName(QStringLiteral("case-us-share"));
    share_->setAccessibleName(tr("Share of the ultrasound"));
    share_->setToolTip(tr("Left: CT only. Right: ultrasound only. Checkerboard: size of the fields"));
    share_->setRange(0, 100);
    share_->setValue(50);
    row->addWidget(fusion_);
    row->addWidget(share_, 1);
    content()->addLayout(row);
    connect(fusion_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this] { compare(); });
    connect(share_, &QSlider::valueChanged, this, [this] { compare(); });
    is_used_ = new QCheckBox(tr("Trainees see this ultrasound"));
    is_used_->setObjectName(QStringLiteral("case-us-used"));
    is_used_->setToolTip(tr("Attempts begin with the recorded ultrasound; outside it, the simulated one is shown"));
    connect(is_used_, &QCheckBox::clicked, this, [this](bool is_on) {
      editor_.edit(case_builder::use_recorded_ultrasound(editor_.draft(), is_on), "choose the ultrasound");
    });
    content()->addWidget(is_used_);
  }

  void compare() {
    constexpr double kSmallest_mm = 5.0, kLargest_mm = 40.0;
    slices::FusionStyle style;
    style.kind = static_cast<slices::FusionKind>(fusion_->currentData().toInt());
    style.share = 0.01 * share_->value();
    style.field_mm = kSmallest_mm + style.share * (kLargest_mm - kSmallest_mm);
    Q_EMIT fusion_changed(style);
  }

  QString describe(const case_builder::CaseDraft& draft) const {
    if (!editor_.has_patient()) return tr("Import a patient first (step 1).");
    if (!draft.ultrasound) return tr("None: trainees get ultrasound that is simulated from the CT.");
    const volume::GridGeometry& grid = draft.ultrasound->gray_U.geometry;
    const Vec3 size_mm = grid.spacing_mm.cwiseProduct(volume::to_vec3(grid.size));
    return tr("%1: %2 × %3 × %4 mm")
        .arg(to_qt(draft.ultrasound->source).section(QLatin1Char('/'), -1))
        .arg(size_mm.x(), 0, 'f', 0)
        .arg(size_mm.y(), 0, 'f', 0)
        .arg(size_mm.z(), 0, 'f', 0);
  }

  QString describe_pose(const case_builder::CaseDraft& draft) const {
    if (!draft.ultrasound) return {};
    if (!draft.placement) return tr("No pose yet.");
    switch (draft.placement->origin) {
      case case_builder::PlacementOrigin::kSaved:
        return tr("Pose: as saved with the case.");
      case case_builder::PlacementOrigin::kLandmarks:
        return tr("Pose: fit of the landmarks.");
      case case_builder::PlacementOrigin::kOptimised:
        break;
    }
    return tr("Pose: optimised, confidence %1.").arg(draft.placement->confidence, 0, 'f', 2);
  }

  QLineEdit* file_ = nullptr;
  QComboBox* axis_ = nullptr;
  QPushButton* read_ = nullptr;
  QPushButton* remove_ = nullptr;
  QLabel* volume_text_ = nullptr;
  CaseLandmarkPairs* pairs_ = nullptr;
  QComboBox* start_ = nullptr;
  QPushButton* register_ = nullptr;
  QLabel* pose_text_ = nullptr;
  QComboBox* fusion_ = nullptr;
  QSlider* share_ = nullptr;
  QCheckBox* is_used_ = nullptr;
};

}  // namespace

CasePanel* make_ultrasound_panel(CaseEditor& editor, QWidget* parent) {
  return new UltrasoundPanel(editor, parent);
}

}  // namespace trocar::trainer
