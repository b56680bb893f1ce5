#pragma once

class QListView;

namespace trocar::trainer {

/// Wraps the text of rows and sets row heights to their lines. Without it, a list reserves space for a scroll bar when
/// it computes heights, but draws without that space if there is no scroll bar.
void wrap_rows(QListView& list);

}  // namespace trocar::trainer
