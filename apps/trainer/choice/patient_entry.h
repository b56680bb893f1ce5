#pragma once

#include <QString>
#include <QStringList>
#include <vector>

namespace trocar::trainer {

/// A patient in the list of the start page.
struct PatientEntry {
  QString source;       ///< Name of an embedded patient, or a folder.
  QString name;         ///< Name for display.
  QString task;         ///< Title of the task; empty: any task.
  QString description;  ///< One line.
  QString details;      ///< Briefing, or the folder; may be empty.
  QString thumbnail;    ///< File of its picture; empty: none.
  int difficulty = 0;   ///< 1 (easiest) to 5; 0: not known.
};

/// Embedded patients that support a task (`task`: its name, `task_title`: its title), by their difficulty.
std::vector<PatientEntry> embedded_entries(const QString& task, const QString& task_title);
/// A patient folder with the name, task and picture stored in it; a folder that cannot be read by its own name.
PatientEntry folder_entry(const QString& folder);

/// "difficulty 2 of 5"; empty for 0.
QString difficulty_text(int difficulty);
/// Everything that a card shows, as one sentence for screen readers.
QString spoken_text(const PatientEntry& entry);

}  // namespace trocar::trainer
