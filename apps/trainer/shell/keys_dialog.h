#pragma once

class QWidget;

namespace trocar::trainer {

class Workspace;

/// Shows all keys and mouse actions (F1): those of the window, and those of the views of a workspace.
void show_keys(QWidget* parent, const Workspace& workspace);

}  // namespace trocar::trainer
