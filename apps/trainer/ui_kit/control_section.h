#pragma once

#include <QString>

class QGridLayout;
class QVBoxLayout;
class QWidget;

namespace trocar::trainer {

/// A section of a panel of controls: a new widget with a heading (empty: none), and the column for its content.
QVBoxLayout* make_section(QWidget*& widget, const QString& heading);
/// Rows of name, control and value.
QGridLayout* make_control_grid();

}  // namespace trocar::trainer
