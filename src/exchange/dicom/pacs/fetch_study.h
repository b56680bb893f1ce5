#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "dicom/pacs/pacs_source.h"

namespace trocar::dicom {

struct FetchOptions {
  std::string study_uid;
  std::vector<std::string> series;     ///< UIDs, or numbers in the list of list_study; empty: all that Trocar can use.
  bool keeps_identity = false;         ///< Writes the objects as they are, with the patient's identity.
  std::function<bool()> is_cancelled;  ///< May be empty.
};

/// A series that was written.
struct FetchedSeries {
  std::size_t number = 0;  ///< In the list of list_study.
  std::string uid;         ///< As written: replaced unless the identity is kept.
  std::string modality;
  std::size_t images = 0;        ///< Objects written.
  std::filesystem::path folder;  ///< In the output folder.
};

struct FetchedStudy {
  std::vector<FetchedSeries> series;
  std::vector<std::string> warnings;  ///< Without the identity of the patient.
};

/// The series of a study in the order of their numbers, then of their UIDs: the first is number 1, whatever the
/// protocol. Errors: those of the source; no such study; `study_uid` is no UID (exit status 2).
Result<std::vector<SeriesEntry>> list_study(PacsSource& source, const std::string& study_uid);

/// Retrieves series of a study into a new folder: one sub-folder for each series, one file for each object, in the
/// order of their numbers. Objects are anonymised while they arrive (see detail/kept_elements.h): no identified object
/// is ever in a named file. References between the objects of one call stay valid. The folder is written completely or
/// not at all. Errors: those of the source; an object of another study or series, or one that is no DICOM; fewer
/// objects than the PACS announced; full disk; existing folder.
Result<FetchedStudy> fetch_study(PacsSource& source, const FetchOptions& options, const std::filesystem::path& out,
                                 const Progress& progress = {});

}  // namespace trocar::dicom
