#include "script/english_text.h"

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAction>
#include <QComboBox>
#include <QGroupBox>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QRegularExpression>

namespace trocar::trainer {
namespace {

/// Frequent words of English that German, French, Spanish and Italian do not have.
bool is_english(QString text) {
  static const QRegularExpression citation(QStringLiteral("<span lang=\"en\">.*</span>"));
  static const QRegularExpression tag(QStringLiteral("<[^>]*>"));
  static const QRegularExpression words(
      QStringLiteral("\\b(the|of|and|with|is|are|from|this|that|has|have|not|for|needle|image|images|view|views|forces|"
                     "click|press|hold|left|right|wheel|attempt|score|skin|liver|body|path|depth|settings|step|slice|"
                     "target|entry|through|between|cannot|until|when|which|you|your|by|new|save|open|close|show)\\b"),
      QRegularExpression::CaseInsensitiveOption);
  // Files, addresses and identifiers (liver-sweep) are the same in every language.
  static const QRegularExpression names(QStringLiteral("\\S*[/_@]\\S*|\\S+\\.[a-z]{2,}\\S*|\\b[a-z]+-[a-z0-9-]+"));
  return text.remove(citation).remove(tag).remove(names).contains(words);
}

QStringList texts_of(const QWidget& widget) {
  QStringList texts{widget.toolTip(), widget.accessibleName(), widget.statusTip(), widget.whatsThis()};
  if (const auto* button = qobject_cast<const QAbstractButton*>(&widget)) texts << button->text();
  if (const auto* label = qobject_cast<const QLabel*>(&widget)) texts << label->text();
  if (const auto* box = qobject_cast<const QGroupBox*>(&widget)) texts << box->title();
  if (const auto* line = qobject_cast<const QLineEdit*>(&widget)) texts << line->placeholderText();
  if (const auto* menu = qobject_cast<const QMenu*>(&widget))
    for (const QAction* action : menu->actions()) texts << action->text();
  const QAbstractItemModel* model = nullptr;
  if (const auto* view = qobject_cast<const QAbstractItemView*>(&widget)) model = view->model();
  if (const auto* combo = qobject_cast<const QComboBox*>(&widget)) model = combo->model();
  if (model == nullptr) return texts;
  for (int column = 0; column < model->columnCount(); ++column) {
    texts << model->headerData(column, Qt::Horizontal).toString();
    for (int row = 0; row < model->rowCount(); ++row)
      for (const int role : {Qt::DisplayRole, Qt::ToolTipRole, Qt::AccessibleTextRole})
        texts << model->index(row, column).data(role).toString();
  }
  return texts;
}

}  // namespace

QStringList find_english(const QWidget& window) {
  QStringList found;
  for (const QWidget* widget : window.findChildren<QWidget*>())
    for (const QString& text : texts_of(*widget))
      if (const QString line = QStringLiteral("%1: %2").arg(widget->objectName(), text); is_english(text))
        if (!found.contains(line)) found << line;
  return found;
}

}  // namespace trocar::trainer
