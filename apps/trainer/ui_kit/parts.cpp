#include "ui_kit/parts.h"

#include <QFrame>
#include <QLabel>
#include <QPushButton>
#include <QScrollArea>
#include <QStyle>
#include <QToolButton>
#include <QVBoxLayout>
#include <QVariant>

namespace trocar::trainer {
namespace {

template <class Button>
Button* dress(Button* button, const char* name, const QString& text, const QString& tooltip, const QString& shortcut) {
  button->setObjectName(QString::fromLatin1(name));
  button->setText(text);
  button->setAccessibleName(text);
  button->setToolTip(shortcut.isEmpty() ? tooltip : tooltip + QStringLiteral("  (") + shortcut + QStringLiteral(")"));
  if (!shortcut.isEmpty()) button->setShortcut(QKeySequence(shortcut));
  return button;
}

}  // namespace

QLabel* make_label(const QString& text, const char* role, QWidget* parent) {
  auto* label = new QLabel(text, parent);
  if (*role != '\0') label->setProperty("role", QString::fromLatin1(role));
  return label;
}

QPushButton* make_button(const char* name, const QString& text, const QString& tooltip, const QString& shortcut) {
  return dress(new QPushButton, name, text, tooltip, shortcut);
}

QToolButton* make_tool_button(const char* name, const QString& text, const QString& tooltip, const QString& shortcut) {
  return dress(new QToolButton, name, text, tooltip, shortcut);
}

QFrame* make_card(const QString& heading, QBoxLayout*& content) {
  auto* card = new QFrame;
  card->setProperty("role", "card");
  content = new QVBoxLayout(card);
  content->setContentsMargins(16, 14, 16, 16);
  content->setSpacing(10);
  if (!heading.isEmpty()) content->addWidget(make_label(heading, "heading"));
  return card;
}

QScrollArea* make_scrolled(QWidget& content) {
  auto* area = new QScrollArea;
  area->setFrameShape(QFrame::NoFrame);
  area->setWidgetResizable(true);
  area->setFocusPolicy(Qt::NoFocus);
  area->setWidget(&content);
  return area;
}

void set_style(QWidget& widget, const char* property, const QVariant& value) {
  if (widget.property(property) == value) return;
  widget.setProperty(property, value);
  widget.style()->unpolish(&widget);
  widget.style()->polish(&widget);
}

void set_label_text(QLabel& label, const QString& text) {
  if (label.text() != text) label.setText(text);
}

void clear_layout(QLayout& layout) {
  while (QLayoutItem* item = layout.takeAt(0)) {
    delete item->widget();
    delete item;
  }
}

QString to_qt(std::string_view text) {
  return QString::fromUtf8(text.data(), static_cast<int>(text.size()));
}

std::string to_std(const QString& text) {
  return text.toStdString();
}

}  // namespace trocar::trainer
