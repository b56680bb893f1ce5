#include "cli/patient_option.h"

#include "io/patient/patient_cache.h"

namespace trocar::cli {

void add_cache_option(Command& command, io::PatientSource& source) {
  source.cache_folder = io::patient_cache_folder();
  command.add_flag(
      "--no-cache", [&source] { source.cache_folder.clear(); },
      "Generate an embedded patient again instead of reading it from the cache");
}

}  // namespace trocar::cli
