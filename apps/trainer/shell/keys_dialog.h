#pragma once

class QWidget;

namespace trocar::trainer {

class Workspace;

/// All keys and mouse actions, on F1: those of the window, and those of the views of a workspace.
void show_keys(QWidget* parent, const Workspace& workspace);

}  // namespace trocar::trainer
