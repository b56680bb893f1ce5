#include "cli/breathing_option.h"

namespace trocar::cli {

void add_breathing_options(Command& command, std::string& breathing, std::optional<double>& phase) {
  command.add_option("--breathing", breathing,
                     "How the patient breathes: none, quiet (liver 10 mm), deep (24.4 mm) or the liver's motion in mm, "
                     "then for example ,rate=18,irregularity=0.3,cough=40,hold-limit=12,seed=3");
  command
      .add_option("--phase", phase, "Hold the patient at this phase of the breath: 0 end-expiration, 0.5 inspiration")
      .number_within(0.0, 1.0, "");
}

}  // namespace trocar::cli
