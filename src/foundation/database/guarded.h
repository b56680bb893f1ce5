#pragma once

#include <exception>
#include <filesystem>
#include <string>

#include "core/result.h"

namespace trocar::database {

/// The database's message, in one line without SOCI's function names.
std::string reason_of(const std::exception& error);

/// Runs `work` and converts SOCI's exceptions into an Error.
template <class Work>
Status guarded(const char* what, const std::filesystem::path& path, const char* advice, const Work& work) {
  try {
    work();
    return {};
  } catch (const std::exception& error) {
    return fail(std::string(what) + ": " + reason_of(error), path.string(), advice);
  }
}

}  // namespace trocar::database
