#pragma once

#include <QString>
#include <string>

namespace trocar::trainer {

/// The name of a landmark for the text that the window shows or somebody typed: a name of the list or "landmark 3" in
/// the window's language becomes that of the case's file; any other name stays as it is.
std::string landmark_of(const QString& text);

}  // namespace trocar::trainer
