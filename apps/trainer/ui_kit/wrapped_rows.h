#pragma once

class QListView;

namespace trocar::trainer {

/// Rows whose text breaks into lines, each as high as its lines: a list keeps room for a scroll bar when it counts
/// them, and would draw without that room where there is no bar.
void wrap_rows(QListView& list);

}  // namespace trocar::trainer
