#include "cli/session/past_sessions.h"

#include <fmt/format.h>

#include <filesystem>

#include "attempt/record/session_case.h"
#include "cli/output.h"
#include "core/files/folders.h"

namespace trocar::cli {

Result<learning::History> read_past_sessions(const std::string& folder) {
  std::error_code error;
  if (!folder.empty() && !std::filesystem::is_directory(folder, error))
    return fail_usage("no such folder", folder, "name a folder of session files");
  TROCAR_TRY(learning::History history,
             learning::read_history(folder.empty() ? user_state_folder() / "sessions" : std::filesystem::path(folder)));
  for (const std::string& line : history.damaged) print_warning(line);
  return history;
}

void warn_of_forces(const storage::SessionInfo& info, const std::string& session) {
  if (const std::string note = attempt::other_forces_note(info); !note.empty())
    print_warning(fmt::format("{} — {}", note, session));
}

}  // namespace trocar::cli
