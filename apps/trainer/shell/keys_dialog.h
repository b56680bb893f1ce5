#pragma once

class QWidget;

namespace trocar::trainer {

/// All keys and mouse actions, on F1.
void show_keys(QWidget* parent);

}  // namespace trocar::trainer
