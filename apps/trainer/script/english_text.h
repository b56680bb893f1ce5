#pragma once

#include <QStringList>

class QWidget;

namespace trocar::trainer {

/// Texts of a window that contain English words: on its widgets and in their lists, tool tips and accessible names, as
/// "begin: Start the attempt". For a window in another language. Pictures that are drawn are not read.
QStringList find_english(const QWidget& window);

}  // namespace trocar::trainer
