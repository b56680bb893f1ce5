#pragma once

#include <QString>
#include <QStringList>
#include <filesystem>
#include <vector>

#include "core/result.h"

namespace trocar::trainer {

/// One line of a script.
struct ScriptStep {
  QString script;  ///< Name of its script, for messages.
  int line = 0;
  QString verb;
  QStringList arguments;  ///< A quoted text is one argument.
};

/// User actions, one per line; # starts a comment, "…" quotes an argument with spaces. The player waits for a widget
/// that is not visible or disabled, as a user would. Seconds count while the window keeps up: on a busy machine a
/// script has more time.
///
///   click NAME [X Y]            left button, at a position in 0..1 of the widget; also double-click, right-click
///   drag NAME X1 Y1 X2 Y2 [left|right|middle] [SECONDS]
///   wheel NAME STEPS [X Y]      positive: away from the user
///   wheel-until NAME STEPS_PER_S FACT OP VALUE [within SECONDS]
///   key KEYS [TIMES]            "Ctrl+Z", "Space", to the focused widget
///   key-until KEYS A_SECOND FACT OP VALUE [within SECONDS]
///   hold KEY, release KEY       a pedal
///   type TEXT                   to the focused widget
///   choose NAME TEXT            an entry of a list, box or tab
///   set NAME VALUE              a slider, number, check box or text field
///   wait SECONDS
///   wait-for FACT OP VALUE [within SECONDS]      OP: is isnt has < > <= >=; default 30 s
///   expect FACT OP VALUE [within SECONDS]        polls until true, default 10 s
///   expect-pixels NAME #RRGGBB TOLERANCE LEAST_SHARE [within SECONDS]    share of the widget's pixels near a colour
///   resize COLUMNS ROWS
///   screenshot FILE [NAME]      of the window or a widget
///   end-server needle|probe     kills the server, for tests
///   close-window                as the user closes it
///   end-window                  kills the program itself, for tests of recovery
///   reset-watch
///   print FACT…
///
/// Facts are state variables of the window (MainWindow::facts): page, phase, depth_mm, distance_mm, score …
Result<std::vector<ScriptStep>> parse_script(const QString& text, const QString& name);
Result<std::vector<ScriptStep>> load_script(const std::filesystem::path& path);

}  // namespace trocar::trainer
