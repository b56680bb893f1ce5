#pragma once

#include <QString>
#include <QStringList>
#include <filesystem>
#include <vector>

#include "core/result.h"

namespace trocar::trainer {

/// One line of a script.
struct ScriptStep {
  int line = 0;
  QString verb;
  QStringList arguments;  ///< Quoted ones are one.
};

/// A user's steps, a line each; # begins a comment, "…" holds words together. A widget that is not to be seen or is
/// disabled is waited for as long as a person would.
///
///   click NAME [X Y]            left button, at a place in 0..1 of the widget; also double-click, right-click
///   drag NAME X1 Y1 X2 Y2 [left|right|middle] [SECONDS]
///   wheel NAME STEPS [X Y]      positive: away from the user
///   wheel-until NAME STEPS_PER_S FACT OP VALUE [within SECONDS]
///   key KEYS [TIMES]            "Ctrl+Z", "Space", to what has the focus
///   key-until KEYS A_SECOND FACT OP VALUE [within SECONDS]
///   type TEXT                   to what has the focus
///   choose NAME TEXT            an entry of a list, box or tab
///   set NAME VALUE              a slider, number, check box or text field
///   wait SECONDS
///   wait-for FACT OP VALUE [within SECONDS]      OP: is isnt has < > <= >=; 30 s unless told
///   expect FACT OP VALUE [within SECONDS]        looks again until it is so, for 10 s unless told
///   expect-pixels NAME #RRGGBB TOLERANCE LEAST_SHARE [within SECONDS]    share of the widget's pixels near a colour
///   resize COLUMNS ROWS
///   screenshot FILE [NAME]      of the window or a widget
///   end-server needle|probe     kills it, to see what happens
///   close-window                as its user closes it
///   end-window                  kills the program itself: what it leaves must be found again
///   reset-watch
///   print FACT…
///
/// Facts are what the window tells of itself (MainWindow::facts): page, phase, depth_mm, distance_mm, score …
Result<std::vector<ScriptStep>> parse_script(const QString& text, const QString& name);
Result<std::vector<ScriptStep>> load_script(const std::filesystem::path& path);

}  // namespace trocar::trainer
