#pragma once

#include <QStringList>

class QWidget;

namespace trocar::trainer {

/// Buttons and labels of a window that are too small for their text, or that extend beyond their parent, as "begin: 80
/// px wide, needs 96". Widgets that vertical scrolling makes visible are excluded.
QStringList find_cut_off(const QWidget& window);

/// True if the whole widget is on the screen and not covered.
bool is_wholly_visible(const QWidget& widget);

}  // namespace trocar::trainer
