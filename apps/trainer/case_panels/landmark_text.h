#pragma once

#include <QString>
#include <string>

namespace trocar::trainer {

/// The text of a landmark's name: those of the list and "landmark 3" are shown in the window's language, any other
/// name was typed by somebody and stays as it is.
QString landmark_text(const std::string& name);
/// The name for such a text, also a typed one.
std::string landmark_of(const QString& text);

}  // namespace trocar::trainer
