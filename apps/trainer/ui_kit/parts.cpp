#include "ui_kit/parts.h"

#include <QAbstractButton>
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
Button* dress(Button* button, const char* name, const QString& text, const QString& tooltip) {
  button->setObjectName(QString::fromLatin1(name));
  button->setText(text);
  button->setAccessibleName(text);
  button->setToolTip(tooltip);
  return button;
}

/// Single letters, Space and Enter are left to PageKeys, which knows what has the focus.
bool is_shortcut(const QKeySequence& keys) {
  const QString name = keys.toString(QKeySequence::PortableText);
  return name.contains(QLatin1Char('+')) || (name.size() > 1 && name.startsWith(QLatin1Char('F'))) ||
         name == QLatin1String("Esc");
}

}  // namespace

QLabel* make_label(const QString& text, const char* role, QWidget* parent) {
  auto* label = new QLabel(text, parent);
  if (*role != '\0') label->setProperty("role", QString::fromLatin1(role));
  return label;
}

QPushButton* make_button(const char* name, const QString& text, const QString& tooltip) {
  return dress(new QPushButton, name, text, tooltip);
}

QToolButton* make_tool_button(const char* name, const QString& text, const QString& tooltip) {
  return dress(new QToolButton, name, text, tooltip);
}

void set_button_action(QAbstractButton& button, const QString& text, Action action, const QString& does) {
  button.setText(text);
  button.setAccessibleName(text);
  button.setToolTip(tooltip_of(action, does));
  if (const QKeySequence keys = key_of(action); is_shortcut(keys)) button.setShortcut(keys);
}

QPushButton* make_button(const char* name, const QString& text, Action action, const QString& does) {
  auto* button = dress(new QPushButton, name, text, {});
  set_button_action(*button, text, action, does);
  return button;
}

QToolButton* make_tool_button(const char* name, const QString& text, Action action, const QString& does) {
  auto* button = dress(new QToolButton, name, text, {});
  set_button_action(*button, text, action, does);
  return button;
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
