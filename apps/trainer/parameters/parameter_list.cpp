#include "parameters/parameter_list.h"

#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>
#include <algorithm>

#include "anatomy/structure_words.h"
#include "ui_kit/parts.h"

namespace trocar::trainer {
namespace {

QString tissue_title(const std::string& tissue) {
  if (tissue == "transfer") return ParameterList::tr("Unlabelled tissue, by HU");
  QString title = shown(anatomy::structure_words(tissue));
  if (tissue == "csf" && window_language().is_english()) return title.toUpper();
  title[0] = title[0].toUpper();
  return title;
}

/// "0–2 mm": depth range of a tissue on the path; several ranges are given from first to last.
QString depth_range_of(const std::string& tissue, const std::vector<cases::PathPiece>& pieces) {
  double from = 0.0, to = -1.0;
  for (const cases::PathPiece& piece : pieces) {
    if (piece.tissue != tissue) continue;
    if (to < 0.0) from = piece.from_mm;
    to = piece.to_mm;
  }
  return to < 0.0 ? QString() : QStringLiteral("%L1–%L2 mm").arg(from, 0, 'f', 0).arg(to, 0, 'f', 0);
}

std::vector<std::string> along_path(const std::vector<cases::PathPiece>& pieces) {
  std::vector<std::string> names;
  for (const cases::PathPiece& piece : pieces)
    if (std::find(names.begin(), names.end(), piece.tissue) == names.end()) names.push_back(piece.tissue);
  return names;
}

bool is_felt_in(const anatomy::TissueParameter& parameter, const std::string& model) {
  if (model == "proxy") return parameter.is_proxy;
  return model == "combined" ? parameter.is_combined : parameter.is_insertion;
}

}  // namespace

ParameterList::ParameterList(QWidget* parent) : QWidget(parent) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
}

void ParameterList::show_tissues(const std::vector<anatomy::TissueParameterGroup>& groups,
                                 const std::vector<cases::PathPiece>& pieces) {
  sections_.clear();
  rows_.clear();
  body_ = nullptr;
  reset_tissue_ = nullptr;
  delete page_;
  page_ = new QWidget;
  auto* all = new QVBoxLayout(page_);
  all->setContentsMargins(0, 0, 8, 0);
  all->setSpacing(4);
  sections_.reserve(groups.size());
  all->addWidget(make_label(tr("Along the planned path"), "dim"));
  const std::vector<std::string> first = along_path(pieces);
  for (const std::string& name : first)
    for (const anatomy::TissueParameterGroup& group : groups)
      if (group.name == name) add_section(group, depth_range_of(name, pieces), *all);
  all->addSpacing(8);
  all->addWidget(make_label(tr("Other tissues"), "dim"));
  for (const anatomy::TissueParameterGroup& group : groups)
    if (std::find(first.begin(), first.end(), group.name) == first.end()) add_section(group, {}, *all);
  all->addStretch(1);
  layout()->addWidget(page_);
  const auto is_chosen = [&](const Section& section) { return section.group.name == chosen_; };
  const bool is_there = std::any_of(sections_.begin(), sections_.end(), is_chosen);
  choose(is_there || sections_.empty() ? chosen_ : sections_.front().group.name);
}

void ParameterList::add_section(const anatomy::TissueParameterGroup& group, const QString& place, QVBoxLayout& into) {
  Section section{group, tissue_title(group.name), place, new QPushButton, new QVBoxLayout};
  section.header->setObjectName(QStringLiteral("parameter-tissue-") + to_qt(group.name));
  section.header->setAccessibleName(section.title);
  section.header->setToolTip(tr("Show the parameters of this tissue  (Space)"));
  section.header->setCheckable(true);
  section.header->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);  // A long text must not widen the list.
  section.header->setStyleSheet(QStringLiteral("text-align: left; padding: 5px 8px"));
  connect(section.header, &QPushButton::clicked, this,
          [this, name = group.name](bool is_open) { choose(is_open ? name : std::string()); });
  into.addWidget(section.header);
  into.addLayout(section.content);
  sections_.push_back(std::move(section));
  show_header(sections_.back(), false);
}

void ParameterList::show_header(Section& section, bool is_changed) const {
  const bool is_open = section.group.name == chosen_;
  QString text = (is_open ? QStringLiteral("▾  ") : QStringLiteral("▸  ")) + section.title;
  if (!section.place.isEmpty()) text += QStringLiteral("   ") + section.place;
  if (is_changed) text += QStringLiteral("   ● ") + tr("changed");
  section.header->setText(text);
  section.header->setChecked(is_open);
}

void ParameterList::choose(const std::string& tissue) {
  // The focus may be in a widget that is deleted.
  for (const Section& section : sections_)
    if (body_ != nullptr && section.group.name == chosen_ && body_->isAncestorOf(focusWidget()))
      section.header->setFocus();
  chosen_ = tissue;
  rows_.clear();
  reset_tissue_ = nullptr;
  if (body_ != nullptr) {
    body_->hide();
    body_->deleteLater();  // The signal may come from a row that is deleted.
    body_->setParent(nullptr);
    body_ = nullptr;
  }
  for (Section& section : sections_)
    if (section.group.name == chosen_) fill(section);
}

void ParameterList::fill(Section& section) {
  body_ = make_rows(section.group);
  section.content->addWidget(body_);
  // Tab moves from the header to its rows.
  QWidget* last = section.header;
  for (ParameterRow* row : rows_)
    for (QWidget* part : row->findChildren<QWidget*>())
      if (part->focusPolicy() != Qt::NoFocus) {
        setTabOrder(last, part);
        last = part;
      }
  setTabOrder(last, reset_tissue_);
  Q_EMIT opened(section.header);
}

QRect ParameterList::chosen_rect() const {
  const auto place = [this](const QWidget& part) { return QRect(part.mapTo(this, QPoint()), part.size()); };
  for (const Section& section : sections_)
    if (section.group.name == chosen_ && body_ != nullptr) return place(*section.header).united(place(*body_));
  return {};
}

QWidget* ParameterList::make_rows(const anatomy::TissueParameterGroup& group) {
  auto* body = new QWidget;
  auto* layout = new QVBoxLayout(body);
  layout->setContentsMargins(8, 4, 0, 12);
  layout->setSpacing(4);
  const QString name = QStringLiteral("parameter-") + to_qt(group.name) + QLatin1Char('-');
  if (group.name == "transfer") {
    auto* note = make_label(tr("× multiplies a complete curve over HU."), "dim");
    note->setWordWrap(true);
    layout->addWidget(note);
  }
  for (const anatomy::TissueParameter& parameter : group.parameters) {
    auto* row = new ParameterRow(parameter, name + to_qt(parameter.key));
    connect(row, &ParameterRow::edited, this,
            [this, setting = parameter.setting](double value, bool joins) { Q_EMIT edited(setting, value, joins); });
    connect(row, &ParameterRow::reset_asked, this,
            [this, setting = parameter.setting] { Q_EMIT reset_asked(setting); });
    rows_.push_back(row);
    layout->addWidget(row);
  }
  reset_tissue_ = new QPushButton(tr("↺  Reset %1").arg(tissue_title(group.name)));
  reset_tissue_->setObjectName(name + QStringLiteral("reset-all"));
  reset_tissue_->setAccessibleName(tr("Reset %1").arg(tissue_title(group.name)));
  reset_tissue_->setToolTip(tr("Reset all parameters of this tissue to their defaults"));
  connect(reset_tissue_, &QPushButton::clicked, this,
          [this, tissue = group.name] { Q_EMIT reset_tissue_asked(tissue); });
  layout->addWidget(reset_tissue_);
  return body;
}

void ParameterList::show_values(const ParameterEdits& edits) {
  for (Section& section : sections_) {
    const bool is_changed = edits.is_changed(section.group);
    show_header(section, is_changed);
    if (section.group.name == chosen_ && reset_tissue_ != nullptr) reset_tissue_->setEnabled(is_changed);
  }
  for (ParameterRow* row : rows_) {
    row->show_value(edits.value_of(row->parameter()));
    row->set_felt(is_felt_in(row->parameter(), model_));
  }
}

void ParameterList::show_model(const QString& force_model) {
  model_ = to_std(force_model);
  for (ParameterRow* row : rows_) row->set_felt(is_felt_in(row->parameter(), model_));
}

void ParameterList::show_refusal(const std::string& setting, const QString& text) {
  for (ParameterRow* row : rows_)
    if (row->parameter().setting == setting) row->show_refusal(text);
}

}  // namespace trocar::trainer
