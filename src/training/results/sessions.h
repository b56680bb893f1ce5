#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "learning/curriculum.h"
#include "results/attempts.h"
#include "storage/session_file.h"

namespace trocar::results {

/// Name of this computer.
std::string station_name();

/// What is known of an attempt when it begins; without the time of its begin.
Attempt begun_attempt(const storage::SessionInfo& info, const learning::Curriculum& curriculum);

/// A session file as an attempt of a person. `person_id` empty: the person that the file names. The id of the attempt
/// is that of the file, or (older programs) a digest of it. A killed session is an interrupted attempt. Errors: those
/// of storage::load_session; no person.
Result<AttemptRecord> attempt_of_session(const std::filesystem::path& file, const std::string& person_id,
                                         const learning::Curriculum& curriculum);

struct Imported {
  std::int64_t added = 0;            ///< New, or completed.
  std::int64_t present = 0;          ///< Were in the database already.
  std::vector<std::string> damaged;  ///< One line for each file that could not be read.
};
/// Records a session file with its bytes. Returns the attempt; empty: it was there already.
Result<std::optional<Attempt>> import_session(Repository& repository, const std::filesystem::path& file,
                                              const std::string& person_id, const learning::Curriculum& curriculum);
/// Records all session files of a station's folder that name a person of this database and are not there yet: what a
/// killed program, a lost connection or a full disk left behind.
Result<Imported> import_left_sessions(Repository& repository, const std::filesystem::path& folder,
                                      const learning::Curriculum& curriculum);
/// Writes the recording of an attempt as a session file. Error: it is not kept; the file exists.
Status export_session(Repository& repository, std::string_view attempt_id, const std::filesystem::path& file);

}  // namespace trocar::results
