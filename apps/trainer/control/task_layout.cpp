#include "control/task_layout.h"

#include "workspace/workspace.h"

namespace trocar::trainer {

void choose_layout(const tasks::Task& task, Workspace& workspace) {
  const QString xray = QStringLiteral("X-ray"), usual = QStringLiteral("Puncture");
  const bool is_by_xray = task.guidance == tasks::ImagingModality::kXray;
  if (is_by_xray && workspace.layout_name() == usual) workspace.choose_layout(xray);
  if (!is_by_xray && workspace.layout_name() == xray) workspace.choose_layout(usual);
}

}  // namespace trocar::trainer
