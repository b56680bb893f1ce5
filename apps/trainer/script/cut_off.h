#pragma once

#include <QStringList>

class QWidget;

namespace trocar::trainer {

/// Buttons and labels of a window whose text is wider or higher than they are, or which reach out of their parent, as
/// "begin: 80 px wide, needs 96". Widgets that vertical scrolling brings into sight do not count.
QStringList find_cut_off(const QWidget& window);

/// Whether the whole widget is on the screen, and nothing lies over it.
bool is_wholly_visible(const QWidget& widget);

}  // namespace trocar::trainer
