// Step 1 of the case builder: input files of the case.
#include <QCheckBox>
#include <QComboBox>
#include <QCoreApplication>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QProgressBar>
#include <QPushButton>
#include <QScrollArea>
#include <QSettings>
#include <QTimer>
#include <QVBoxLayout>
#include <algorithm>
#include <memory>
#include <optional>

#include "anatomy/patient.h"
#include "case_builder/case_edits.h"
#include "case_panels/case_panel.h"
#include "patient_builder/plausibility/judge_anatomy.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

constexpr int kMostRecent = 6;
const char* const kRecentKey = "case/recent";

QString first_line(const QString& entry) {
  return entry.section(QLatin1Char('\n'), 0, 0);
}

class ImportPanel final : public CasePanel {
  Q_DECLARE_TR_FUNCTIONS(trocar::trainer::ImportPanel)
 public:
  ImportPanel(case_builder::CaseEditor& editor, QWidget* parent) : CasePanel(editor, parent) {
    add_finding();
    content()->addWidget(make_label(tr("CT, or a complete patient folder"), "dim"));
    ct_ = add_field("case-ct", tr("CT"), tr("Path of a CT: NIfTI, NRRD, MHA, a DICOM folder; or a patient folder"));
    add_choosers();
    content()->addWidget(make_label(tr("Labels (several: separated by ;)"), "dim"));
    labels_ =
        add_field("case-labels", tr("Labels"), tr("Paths of label volumes, masks, .seg.nrrd, or folders of masks"));
    add_label_choosers();
    content()->addWidget(make_label(tr("Names of label numbers"), "dim"));
    map_ = new QComboBox;
    map_->setObjectName(QStringLiteral("case-label-map"));
    map_->setAccessibleName(tr("Names of label numbers"));
    map_->setToolTip(tr("TotalSegmentator's numbers, or a TOML file with a [labels] table"));
    map_->setEditable(true);
    map_->addItem(QStringLiteral("totalsegmentator"));
    content()->addWidget(map_);
    add_posture();
    add_actions();
    content()->addWidget(make_label(tr("Recent"), "dim"));
    recent_ = new QListWidget;
    recent_->setObjectName(QStringLiteral("case-recent"));
    recent_->setAccessibleName(tr("Recent imports"));
    recent_->setToolTip(tr("Double click or Enter fills the fields"));
    recent_->setMaximumHeight(132);
    content()->addWidget(recent_);
    content()->addStretch();
    fill_recent();
    connect(recent_, &QListWidget::itemActivated, this, [this](const QListWidgetItem* item) { use(*item); });
    connect(recent_, &QListWidget::itemClicked, this, [this](const QListWidgetItem* item) { use(*item); });
  }

  void refresh() override {
    const bool is_importing = editor_.work() == case_builder::CaseEditor::Work::kImporting;
    start_->setEnabled(!is_importing);
    if (was_importing_ && !is_importing) {
      has_failed_ = editor_.is_error();
      if (editor_.draft().imported != before_) remember();  // neither failed nor cancelled
      fill_recent();
    }
    const bool has_ended = was_importing_ && !is_importing;
    was_importing_ = is_importing;
    show_finding();
    // The error names options of the command line; here there are buttons.
    if (has_ended && has_failed_ && open_finding_)
      editor_.say(to_std(tr("Not imported: see what was found, and repair or confirm it")), true);
  }

 private:
  QLineEdit* add_field(const char* name, const QString& title, const QString& tooltip) {
    auto* field = new QLineEdit;
    field->setObjectName(QString::fromLatin1(name));
    field->setAccessibleName(title);
    field->setToolTip(tooltip + tr("  (Enter imports)"));
    field->setClearButtonEnabled(true);
    content()->addWidget(field);
    connect(field, &QLineEdit::returnPressed, this, [this] { import(); });
    return field;
  }

  void add_choosers() {
    auto* row = new QHBoxLayout;
    QPushButton* file = make_button("case-ct-file", tr("File…"), tr("Choose a CT file"));
    QPushButton* folder = make_button("case-ct-folder", tr("Folder…"), tr("Choose a DICOM series or a patient folder"));
    row->addWidget(file);
    row->addWidget(folder);
    content()->addLayout(row);
    connect(file, &QPushButton::clicked, this, [this] {
      const QString path =
          QFileDialog::getOpenFileName(this, tr("CT"), {}, tr("Volumes (%1);;All files (*)").arg(volume_patterns()));
      choose_ct(path);
    });
    connect(folder, &QPushButton::clicked, this,
            [this] { choose_ct(QFileDialog::getExistingDirectory(this, tr("DICOM series or patient folder"))); });
  }

  /// Labels of another CT are not those of this one.
  void choose_ct(const QString& path) {
    if (path.isEmpty()) return;
    ct_->setText(path);
    if (has_labels_of_another()) labels_->clear();
    labels_of_ = path;
  }

  /// Labels that were chosen before any CT belong to the first one.
  bool has_labels_of_another() const { return !labels_of_.isEmpty() && labels_of_ != ct_->text().trimmed(); }

  void add_label_choosers() {
    auto* row = new QHBoxLayout;
    QPushButton* files = make_button("case-labels-files", tr("Files…"), tr("Add label files"));
    QPushButton* folder = make_button("case-labels-folder", tr("Folder…"), tr("Add a folder of masks"));
    row->addWidget(files);
    row->addWidget(folder);
    content()->addLayout(row);
    const auto add = [this](const QString& path) {
      if (path.isEmpty()) return;
      // A new selection replaces labels whose import failed, or of another CT; otherwise it is appended.
      const bool is_new = has_failed_ || has_labels_of_another();
      const QString before = is_new ? QString() : labels_->text().trimmed();
      has_failed_ = false;
      labels_of_ = ct_->text().trimmed();
      labels_->setText(before.isEmpty() ? path : before + QStringLiteral(";") + path);
    };
    connect(files, &QPushButton::clicked, this, [this, add] {
      for (const QString& path : QFileDialog::getOpenFileNames(this, tr("Labels"))) add(path);
    });
    connect(folder, &QPushButton::clicked, this,
            [this, add] { add(QFileDialog::getExistingDirectory(this, tr("Folder of masks"))); });
  }

  void add_posture() {
    content()->addWidget(make_label(tr("Posture for the puncture"), "dim"));
    posture_ = new QComboBox;
    posture_->setObjectName(QStringLiteral("case-posture"));
    posture_->setAccessibleName(tr("Posture for the puncture"));
    posture_->setToolTip(
        tr("How the patient lies or sits: a finding tells if the CT was taken otherwise. A complete patient "
           "keeps its own."));
    using enum anatomy::Posture;
    for (const anatomy::Posture posture : {kSupine, kProne, kLeftLateral, kRightLateral, kSitting})
      posture_->addItem(shown(anatomy::posture_words(posture)), to_qt(anatomy::posture_name(posture)));
    content()->addWidget(posture_);
    sibling_ = new QCheckBox(tr("Labels of a sibling series"));
    sibling_->setObjectName(QStringLiteral("case-sibling-series"));
    sibling_->setToolTip(
        tr("Accept a DICOM SEG or RTSTRUCT of another series with the same frame of reference, such as "
           "another reconstruction of the scan"));
    content()->addWidget(sibling_);
  }

  void add_actions() {
    start_ = make_button("case-import", tr("Import"), tr("Read the files and build the patient"));
    start_->setProperty("role", "primary");
    content()->addWidget(start_);
    connect(start_, &QPushButton::clicked, this, [this] { import(); });
  }

  /// What was found about the segmentation as a whole, and how to go on: above the fields, where it is seen.
  void add_finding() {
    finding_ = make_label({});
    finding_->setObjectName(QStringLiteral("case-finding"));
    finding_->setWordWrap(true);
    repair_ = make_button("case-finding-repair", {}, {});
    confirm_ = make_button("case-finding-confirm", tr("It is right: import as it is"),
                           tr("The patient is really like that; the case keeps this confirmation"));
    for (QWidget* widget : std::initializer_list<QWidget*>{finding_, repair_, confirm_}) {
      widget->hide();
      content()->addWidget(widget);
    }
    connect(repair_, &QPushButton::clicked, this, [this] { repair(); });
    connect(confirm_, &QPushButton::clicked, this, [this] {
      if (!open_finding_) return;
      if (has_failed_) {
        confirmed_.push_back(open_finding_->name);
        start();
      } else {
        editor_.edit(case_builder::confirm_finding(editor_.draft(), *open_finding_), "confirm what was found");
      }
    });
  }

  /// The first grave finding that was not confirmed if the import failed because of it, else the first one at all.
  std::optional<patient_builder::AnatomyFinding> next_finding() const {
    if (has_failed_) {
      if (findings_ != nullptr)
        for (const patient_builder::AnatomyFinding& finding : *findings_)
          if (finding.is_grave && std::ranges::count(confirmed_, finding.name) == 0) return finding;
    } else if (editor_.work() != case_builder::CaseEditor::Work::kImporting && editor_.has_patient()) {
      const case_builder::CaseDraft& draft = editor_.draft();
      for (const patient_builder::AnatomyFinding& finding : draft.imported->findings)
        if (!patient_builder::is_confirmed(draft.provenance, finding.name)) return finding;
    }
    return std::nullopt;
  }

  /// The import was started at the panel's lower end.
  void scroll_to_top() {
    for (QWidget* widget = parentWidget(); widget != nullptr; widget = widget->parentWidget())
      if (auto* area = qobject_cast<QScrollArea*>(widget)) return area->ensureVisible(0, 0);
  }

  void show_finding() {
    open_finding_ = next_finding();
    const bool is_open = open_finding_.has_value();
    finding_->setVisible(is_open);
    confirm_->setVisible(is_open);
    repair_->setVisible(is_open && !open_finding_->repair.empty());
    if (!is_open) return finding_->clear();
    if (finding_->text() != shown(open_finding_->text)) QTimer::singleShot(0, this, [this] { scroll_to_top(); });
    finding_->setText(shown(open_finding_->text));
    confirm_->setText(has_failed_ ? tr("It is right: import as it is") : tr("It is right: keep it"));
    const std::string& option = open_finding_->repair;
    repair_->setText(option == patient_builder::kMirrorLabels           ? tr("Mirror the labels and import")
                     : option == patient_builder::kMirrorBoth           ? tr("Mirror CT and labels and import")
                     : option.starts_with(patient_builder::kUsePosture) ? tr("Import with this posture")
                                                                        : tr("Use those numbers and import"));
    repair_->setToolTip(shown(option));
  }

  void repair() {
    if (!open_finding_) return;
    const std::string option = open_finding_->repair;
    if (option == patient_builder::kMirrorLabels) mirroring_ = io::Mirroring::kLabels;
    if (option == patient_builder::kMirrorBoth) mirroring_ = io::Mirroring::kBoth;
    if (option.starts_with(patient_builder::kUseLabelMap))
      map_->setCurrentText(to_qt(option.substr(std::string_view(patient_builder::kUseLabelMap).size())));
    if (option.starts_with(patient_builder::kUsePosture))
      posture_->setCurrentIndex(
          posture_->findData(to_qt(option.substr(std::string_view(patient_builder::kUsePosture).size()))));
    start();
  }

  /// New files: nothing about them has been confirmed.
  void import() {
    confirmed_.clear();
    mirroring_ = io::Mirroring::kNone;
    start();
  }

  void start() {
    case_builder::ImportRequest request;
    request.mirroring = mirroring_;
    request.posture = *anatomy::find_posture(to_std(posture_->currentData().toString()));
    request.sibling_series = sibling_->isChecked();
    request.confirmed = confirmed_;
    request.findings = findings_ = std::make_shared<std::vector<patient_builder::AnatomyFinding>>();
    request.ct = to_std(ct_->text().trimmed());
    labels_of_ = ct_->text().trimmed();
    for (const QString& path : labels_->text().split(QLatin1Char(';')))
      if (!path.trimmed().isEmpty()) request.labels.push_back(to_std(path.trimmed()));
    request.label_map = to_std(map_->currentText().trimmed());
    if (editor_.has_patient()) request.task = editor_.draft().base.name;
    imported_ =
        QStringList{ct_->text().trimmed(), labels_->text().trimmed(), map_->currentText()}.join(QLatin1Char('\n'));
    has_failed_ = false;
    show_finding();
    before_ = editor_.draft().imported;
    editor_.import_patient(std::move(request));
    was_importing_ = true;  // it may end before the next refresh
  }

  /// Stores the fields of the import.
  void remember() const {
    QSettings settings;
    QStringList recent = settings.value(QString::fromLatin1(kRecentKey)).toStringList();
    recent.removeAll(imported_);
    recent.prepend(imported_);
    while (recent.size() > kMostRecent) recent.removeLast();
    settings.setValue(QString::fromLatin1(kRecentKey), recent);
  }

  void fill_recent() {
    recent_->clear();
    for (const QString& entry : QSettings().value(QString::fromLatin1(kRecentKey)).toStringList()) {
      auto* item = new QListWidgetItem(first_line(entry).section(QLatin1Char('/'), -2), recent_);
      item->setData(Qt::UserRole, entry);
      item->setToolTip(first_line(entry));
    }
  }

  void use(const QListWidgetItem& item) {
    const QStringList fields = item.data(Qt::UserRole).toString().split(QLatin1Char('\n'));
    if (fields.size() != 3) return;
    ct_->setText(fields[0]);
    labels_->setText(fields[1]);
    labels_of_ = fields[0];
    map_->setCurrentText(fields[2]);
  }

  QLineEdit* ct_ = nullptr;
  QLineEdit* labels_ = nullptr;
  QString labels_of_;  ///< The CT whose labels the field holds.
  QComboBox* map_ = nullptr;
  QComboBox* posture_ = nullptr;
  QCheckBox* sibling_ = nullptr;
  QPushButton* start_ = nullptr;
  QListWidget* recent_ = nullptr;
  QLabel* finding_ = nullptr;
  QPushButton* repair_ = nullptr;
  QPushButton* confirm_ = nullptr;
  std::shared_ptr<std::vector<patient_builder::AnatomyFinding>>
      findings_;                                                 ///< Of the last import; read when it has ended.
  std::optional<patient_builder::AnatomyFinding> open_finding_;  ///< The one that is displayed.
  std::vector<std::string> confirmed_;
  io::Mirroring mirroring_ = io::Mirroring::kNone;
  QString imported_;                                             ///< The three fields of the last import, a line each.
  std::shared_ptr<const case_builder::ImportedPatient> before_;  ///< Import of the draft when the new import started.
  bool was_importing_ = false;
  bool has_failed_ = false;  ///< The last import failed; a new selection replaces its files.
};

}  // namespace

CasePanel* make_import_panel(case_builder::CaseEditor& editor, QWidget* parent) {
  return new ImportPanel(editor, parent);
}

}  // namespace trocar::trainer
