// Step 6 of the case builder: name, description and output folder.
#include <QCheckBox>
#include <QCoreApplication>
#include <QDir>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QVBoxLayout>

#include "case_panels/case_panel.h"
#include "ui_kit/parts.h"

namespace trocar::trainer {
namespace {

class SavePanel final : public CasePanel {
  Q_DECLARE_TR_FUNCTIONS(trocar::trainer::SavePanel)
 public:
  SavePanel(case_builder::CaseEditor& editor, QWidget* parent) : CasePanel(editor, parent) {
    name_ = add_line("case-name", tr("Name"), tr("Name shown to trainees in the list of cases"));
    connect(name_, &QLineEdit::textEdited, this, [this](const QString& text) {
      case_builder::CaseDraft next = editor_.draft();
      next.name = to_std(text);
      editor_.edit(std::move(next), "name the case", "name");
    });
    description_ =
        add_text("case-description", tr("Description"), tr("Description shown to trainees before they begin"));
    connect(description_, &QPlainTextEdit::textChanged, this, [this] {
      if (is_refreshing_) return;
      case_builder::CaseDraft next = editor_.draft();
      next.description = to_std(description_->toPlainText());
      editor_.edit(std::move(next), "describe the case", "description");
    });
    provenance_ = add_text("case-provenance", tr("Source of the data, one line each"),
                           tr("Data set, licence, who made the labels"));
    connect(provenance_, &QPlainTextEdit::textChanged, this, [this] {
      if (is_refreshing_) return;
      case_builder::CaseDraft next = editor_.draft();
      next.provenance.clear();
      for (const QString& line : provenance_->toPlainText().split(QLatin1Char('\n')))
        if (!line.trimmed().isEmpty()) next.provenance.push_back(to_std(line.trimmed()));
      editor_.edit(std::move(next), "say where it comes from", "provenance");
    });
    add_folder();
    content()->addStretch();
  }

  void refresh() override {
    is_refreshing_ = true;
    const case_builder::CaseDraft& draft = editor_.draft();
    if (!name_->hasFocus()) name_->setText(to_qt(draft.name));
    if (!description_->hasFocus() && description_->toPlainText() != to_qt(draft.description))
      description_->setPlainText(to_qt(draft.description));
    QStringList lines;
    for (const std::string& line : draft.provenance) lines << to_qt(line);
    if (!provenance_->hasFocus() && provenance_->toPlainText() != lines.join(QLatin1Char('\n')))
      provenance_->setPlainText(lines.join(QLatin1Char('\n')));
    save_->setEnabled(editor_.has_patient() && editor_.work() == case_builder::CaseEditor::Work::kNone);
    open_->setEnabled(editor_.is_saved());
    is_refreshing_ = false;
  }

 private:
  QLineEdit* add_line(const char* name, const QString& title, const QString& tooltip) {
    content()->addWidget(make_label(title, "dim"));
    auto* field = new QLineEdit;
    field->setObjectName(QString::fromLatin1(name));
    field->setAccessibleName(title);
    field->setToolTip(tooltip);
    content()->addWidget(field);
    return field;
  }

  QPlainTextEdit* add_text(const char* name, const QString& title, const QString& tooltip) {
    content()->addWidget(make_label(title, "dim"));
    auto* field = new QPlainTextEdit;
    field->setObjectName(QString::fromLatin1(name));
    field->setAccessibleName(title);
    field->setToolTip(tooltip + tr("  (Tab goes on)"));
    field->setTabChangesFocus(true);
    field->setMaximumHeight(72);
    content()->addWidget(field);
    return field;
  }

  void add_folder() {
    folder_ = add_line("case-folder", tr("Folder to create"), tr("Folder for the case  (Enter saves)"));
    folder_->setText(QDir::home().filePath(QStringLiteral("trocar-cases/my-case")));
    QPushButton* choose =
        make_button("case-folder-choose", tr("Choose…"), tr("Select the parent folder of the case folder"));
    replaces_ = new QCheckBox(tr("Replace the existing case"));
    replaces_->setObjectName(QStringLiteral("case-replace"));
    replaces_->setToolTip(tr("Without this option, nothing is overwritten"));
    save_ = make_button("case-save", tr("Save"), Action::kSaveCase, tr("Write the case completely or not at all"));
    save_->setProperty("role", "primary");
    open_ = make_button("case-open", tr("Open this case"), tr("Start an attempt with the saved case"));
    content()->addWidget(choose);
    content()->addWidget(replaces_);
    content()->addWidget(save_);
    content()->addWidget(open_);
    connect(choose, &QPushButton::clicked, this, [this] {
      const QString parent = QFileDialog::getExistingDirectory(this, tr("Parent folder of the case"));
      if (!parent.isEmpty())
        folder_->setText(QDir(parent).filePath(name_->text().trimmed().replace(QLatin1Char(' '), QLatin1Char('-'))));
    });
    connect(save_, &QPushButton::clicked, this, [this] { save(); });
    connect(folder_, &QLineEdit::returnPressed, this, [this] { save(); });
    connect(open_, &QPushButton::clicked, this, [this] { Q_EMIT case_opened(to_qt(editor_.saved_folder().string())); });
  }

  void save() {
    case_builder::SaveOptions options;
    options.folder = to_std(folder_->text().trimmed());
    options.overwrites = replaces_->isChecked();
    editor_.save(std::move(options));
  }

  QLineEdit* name_ = nullptr;
  QPlainTextEdit* description_ = nullptr;
  QPlainTextEdit* provenance_ = nullptr;
  QLineEdit* folder_ = nullptr;
  QCheckBox* replaces_ = nullptr;
  QPushButton* save_ = nullptr;
  QPushButton* open_ = nullptr;
};

}  // namespace

CasePanel* make_save_panel(case_builder::CaseEditor& editor, QWidget* parent) {
  return new SavePanel(editor, parent);
}

}  // namespace trocar::trainer
