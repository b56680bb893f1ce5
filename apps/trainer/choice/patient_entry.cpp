#include "choice/patient_entry.h"

#include <QCoreApplication>
#include <algorithm>

#include "cases/prepare_case.h"
#include "core/files/folders.h"
#include "io/patient/patient_extras.h"
#include "io/patient/patient_folder.h"
#include "phantom/phantom.h"
#include "tasks/task.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

QString from_std(const std::string& text) {
  return QString::fromStdString(text);
}

class PatientEntryText {
  Q_DECLARE_TR_FUNCTIONS(PatientEntryText)
};

QString thumbnail_of(const std::string& source) {
  const auto file = io::find_thumbnail(source);
  return file ? from_std(file->string()) : QString();
}

/// Title of a folder's own task; empty if it has none.
QString own_task_title(const std::string& folder) {
  if (!cases::has_own_task(folder)) return {};
  const auto task = tasks::load_task_file(std::filesystem::path(folder) / tasks::kOwnTaskFile, data_dir() / "tasks");
  return task ? shown(task->title) : QString();
}

}  // namespace

std::vector<PatientEntry> embedded_entries(const QString& task, const QString& task_title) {
  std::vector<PatientEntry> entries;
  const std::string name = task.toStdString();
  for (const phantom::PhantomInfo& info : phantom::embedded_patients()) {
    if (std::find(info.tasks.begin(), info.tasks.end(), name) == info.tasks.end()) continue;
    entries.push_back({from_std(info.name), from_std(info.name), task_title, shown(info.description),
                       shown(info.briefing), thumbnail_of(info.name), info.difficulty});
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const PatientEntry& a, const PatientEntry& b) { return a.difficulty < b.difficulty; });
  return entries;
}

PatientEntry folder_entry(const QString& folder) {
  PatientEntry entry;
  entry.source = folder;
  entry.name = folder.section(QLatin1Char('/'), -1);
  entry.details = folder;
  const std::string path = folder.toStdString();
  const auto title = io::load_patient_title(path);
  if (!title) {
    entry.description = PatientEntryText::tr("This folder cannot be read");
    return entry;
  }
  entry.name = from_std(title->name);
  entry.description = shown(title->description);
  entry.task = own_task_title(path);
  entry.thumbnail = thumbnail_of(path);
  return entry;
}

QString difficulty_text(int difficulty) {
  return difficulty > 0 ? PatientEntryText::tr("difficulty %1 of 5").arg(difficulty) : QString();
}

QString spoken_text(const PatientEntry& entry) {
  QStringList parts{entry.name, entry.task, difficulty_text(entry.difficulty), entry.description};
  parts.removeAll(QString());
  return parts.join(QStringLiteral(", "));
}

}  // namespace trocar::trainer
