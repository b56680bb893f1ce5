#include "shell/keys_dialog.h"

#include <QDialog>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QScrollArea>
#include <algorithm>
#include <vector>

#include "ui_kit/action_table.h"
#include "ui_kit/parts.h"

namespace trocar::trainer {
namespace {

/// Heading and rows of one scope.
struct KeyGroup {
  QLabel* heading;
  std::vector<std::pair<QLabel*, QLabel*>> rows;  ///< Keys, and what they do.
};

std::vector<KeyGroup> add_groups(QGridLayout& grid) {
  std::vector<KeyGroup> groups;
  int line = 0;
  const char* heading = nullptr;
  Scope scope{};
  for (const ActionRow& row : action_table()) {
    if (heading == nullptr || scope != row.scope) {
      groups.push_back({make_label(scope_title(row.scope), "heading"), {}});
      grid.addWidget(groups.back().heading, line++, 0, 1, 2);
    }
    heading = row.does;
    scope = row.scope;
    auto* keys = make_label(keys_text(row.action), "badge");
    auto* does = make_label(does_text(row.action));
    does->setWordWrap(true);
    grid.addWidget(keys, line, 0, Qt::AlignLeft | Qt::AlignTop);
    grid.addWidget(does, line++, 1, Qt::AlignTop);
    groups.back().rows.emplace_back(keys, does);
  }
  grid.setColumnStretch(1, 1);
  grid.setRowStretch(line, 1);
  return groups;
}

/// A group whose heading contains the text is shown whole.
void filter(const std::vector<KeyGroup>& groups, const QString& text) {
  const auto contains = [&](const QLabel* label) { return label->text().contains(text, Qt::CaseInsensitive); };
  for (const KeyGroup& group : groups) {
    const bool is_whole = contains(group.heading);
    bool is_any_shown = false;
    for (const auto& [keys, does] : group.rows) {
      const bool is_shown = is_whole || contains(keys) || contains(does);
      keys->setVisible(is_shown);
      does->setVisible(is_shown);
      is_any_shown = is_any_shown || is_shown;
    }
    group.heading->setVisible(is_any_shown);
  }
}

}  // namespace

void show_keys(QWidget* parent) {
  QDialog dialog(parent);
  dialog.setObjectName(QStringLiteral("keys"));
  dialog.setWindowTitle(QDialog::tr("Keys and mouse"));
  auto* content = new QWidget;
  auto* grid = new QGridLayout(content);
  grid->setContentsMargins(4, 4, 16, 4);
  grid->setHorizontalSpacing(16);
  grid->setVerticalSpacing(6);
  const std::vector<KeyGroup> groups = add_groups(*grid);
  auto* search = new QLineEdit;
  search->setObjectName(QStringLiteral("keys-filter"));
  search->setAccessibleName(QDialog::tr("Filter"));
  search->setPlaceholderText(QDialog::tr("Filter: a key, or a word such as stylet"));
  search->setClearButtonEnabled(true);
  QObject::connect(search, &QLineEdit::textChanged, content, [&](const QString& text) { filter(groups, text); });
  auto* close = make_button(
      "close-keys", QDialog::tr("Close"),
      QDialog::tr("Closes this  (%1)").arg(QKeySequence(Qt::Key_Escape).toString(QKeySequence::NativeText)));
  close->setAutoDefault(false);
  QObject::connect(close, &QPushButton::clicked, &dialog, &QDialog::accept);
  auto* scrolled = make_scrolled(*content);
  scrolled->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  auto* column = new QVBoxLayout(&dialog);
  column->setContentsMargins(20, 16, 20, 16);
  column->setSpacing(10);
  column->addWidget(search);
  column->addWidget(scrolled, 1);
  column->addWidget(close, 0, Qt::AlignRight);
  constexpr int kColumns = 90;  // average characters
  const QSize most = parent->window()->size() - QSize(80, 80);
  dialog.resize(QSize(dialog.fontMetrics().averageCharWidth() * kColumns, most.height()).boundedTo(most));
  dialog.exec();
}

}  // namespace trocar::trainer
