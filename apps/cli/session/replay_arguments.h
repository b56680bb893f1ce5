#pragma once

#include <initializer_list>
#include <set>
#include <string>

#include "attempt/live/performer.h"
#include "cli/action.h"
#include "io/patient/patient_folder.h"

namespace trocar::cli {

/// The options of a command that were named on the command line, "--seed".
class NamedOptions {
 public:
  void note(const Command& command);
  bool has(const std::string& option) const { return names_.contains(option); }

 private:
  std::set<std::string> names_;
};

/// Fills the arguments of `trocar run` from the session that `--operator replay:SESSION` names, and refuses (exit
/// status 2) those that contradict it. --set, --profile, --tissues and --force-model change the replay on purpose. Has
/// no effect for another operator, which needs a patient.
Status restore_arguments(const NamedOptions& named, cases::CaseOptions& the_case, attempt::RunOptions& run,
                         io::PatientSource& source);

}  // namespace trocar::cli
