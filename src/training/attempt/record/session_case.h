#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cases/prepare_case.h"
#include "core/result.h"
#include "devices/simulated/replay_device.h"
#include "link/messages.h"
#include "storage/session_file.h"

namespace trocar::attempt {

/// Intended differences of a replay: other tissue. Empty: as recorded.
struct ReplayChanges {
  std::vector<std::string> overrides;  ///< Applied to every table of the session: "liver.k=0.5".
  std::string tissue_file, profile;    ///< Replaces every table of the session; empty: none.
  std::string force_model;             ///< Empty: as recorded.

  bool is_any() const noexcept {
    return !overrides.empty() || !tissue_file.empty() || !profile.empty() || !force_model.empty();
  }
};

/// The parameters of a replay: those of the session with the changes, by tick; the first at tick 0. Errors: a number
/// that a table rejects, a session with a damaged table or option.
Result<std::vector<storage::SessionParameters>> replay_parameters(const storage::Session& session,
                                                                  const ReplayChanges& changes);

/// The case of a session: its task, needle, plan, and the tissues in force at its first tick. Errors: another patient
/// (exit status 2) unless is_other_patient_meant, a task or needle that is unknown to this program.
Result<cases::Case> restore_case(std::shared_ptr<const anatomy::VirtualPatient> patient,
                                 const storage::Session& session, const storage::SessionParameters& first,
                                 bool is_other_patient_meant = false);

/// Error (exit status 2): the patient's motion model is not that of the session. A session without one was recorded at
/// rest, whatever the patient has now.
Status check_motion(const storage::Session& session, const anatomy::VirtualPatient& patient);
/// Checks that the session was recorded in that patient, which moved in the same way (exit status 2 if not).
Status check_patient(const storage::Session& session, const anatomy::VirtualPatient& patient);

/// SetParameters message that gives a loaded scene these parameters.
link::SetParameters as_command(const storage::SessionParameters& parameters);

/// "recorded with version 1 of the forces, …", one line, if a session was made with another version of the forces than
/// this program's (haptics/force_version.h): forces that are computed anew from it differ. Empty: the same version.
std::string other_forces_note(const storage::SessionInfo& info);

/// Motion of the stylus that led the needle of a session, for a replay device. Frame: the room in which the session's
/// own plan places the patient. Errors: no ticks, an unknown needle.
Result<devices::RecordedMotion> stylus_motion(const storage::Session& session);

}  // namespace trocar::attempt
