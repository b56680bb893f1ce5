#pragma once

class QWidget;

namespace trocar::trainer {

/// A dialog with the table of actions: keys and mouse actions of each page and view. It fits the parent's window; what
/// does not is scrolled. A text filters the rows.
void show_keys(QWidget* parent);

}  // namespace trocar::trainer
