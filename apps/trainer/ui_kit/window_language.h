#pragma once

#include <QString>
#include <string_view>

#include "language/language.h"

class QCoreApplication;

namespace trocar::trainer {

/// The window's language (docs/languages.md): the code that the settings keep; empty: the desktop's.
QString chosen_language();
/// Keeps the code for the next start.
void choose_language(const QString& code);
/// The first of the desktop's languages that there is, else English.
QString desktop_language();

/// From here on tr(), shown() and decimal signs are those of the language. Widgets that are there keep
/// their texts. Error: the language is unknown or a file of it is broken; then the language stays as it is.
Status speak(QCoreApplication& application, const QString& code);

/// The language of the last call of speak(), English before it.
const language::Language& window_language();

/// A text of the simulation (task, step, hint, tissue, error) in the window's language. Only for the main thread, and
/// never for a text that is kept or compared.
QString shown(std::string_view english);

}  // namespace trocar::trainer
