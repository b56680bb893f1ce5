#include "patient_option.h"

#include <CLI/CLI.hpp>

#include "core/files/user_folders.h"

namespace trocar::cli {

void add_cache_option(CLI::App& command, io::PatientSource& source) {
  source.cache_folder = user_cache_folder() / "patients";
  command.add_flag_callback(
      "--no-cache", [&source] { source.cache_folder.clear(); },
      "Generate an embedded patient again instead of reading it from the cache");
}

}  // namespace trocar::cli
