#pragma once

#include <QString>
#include <QVariant>
#include <string>
#include <string_view>

#include "ui_kit/action_table.h"

class QAbstractButton;
class QBoxLayout;
class QFrame;
class QLabel;
class QLayout;
class QPushButton;
class QScrollArea;
class QToolButton;
class QWidget;

/// Common widgets of all pages, for a uniform look.
namespace trocar::trainer {

/// `role` of the style sheet: "title", "heading", "dim", "badge", "alarm"; empty: plain text.
QLabel* make_label(const QString& text, const char* role = "", QWidget* parent = nullptr);
/// `name` is the object name that scripts use.
QPushButton* make_button(const char* name, const QString& text, const QString& tooltip);
QToolButton* make_tool_button(const char* name, const QString& text, const QString& tooltip);
/// A button for an action of the table, with its tooltip and, where it has a modifier or is a function key or Escape,
/// its key. `does` replaces the table's text in the tooltip.
QPushButton* make_button(const char* name, const QString& text, Action action, const QString& does = {});
QToolButton* make_tool_button(const char* name, const QString& text, Action action, const QString& does = {});
/// Sets text, tooltip and key anew: a new text clears the key.
void set_button_action(QAbstractButton& button, const QString& text, Action action, const QString& does = {});
/// A rounded panel with a heading.
QFrame* make_card(const QString& heading, QBoxLayout*& content);
/// Puts the content in a frameless scroll area, which scrolls if there is not enough space.
QScrollArea* make_scrolled(QWidget& content);
/// Sets a property used by the style sheet and updates the style.
void set_style(QWidget& widget, const char* property, const QVariant& value);
/// Sets the text of a label that does not show it yet.
void set_label_text(QLabel& label, const QString& text);
/// Removes and deletes all items of a layout and their widgets.
void clear_layout(QLayout& layout);

QString to_qt(std::string_view text);
std::string to_std(const QString& text);

}  // namespace trocar::trainer
