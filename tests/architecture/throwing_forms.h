#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Finds forms of the standard library that throw errors of the outside world, and end the program.
namespace trocar::architecture {

/// "path:line: ..." for every thread that is started and every folder that is iterated over outside of
/// core/start_thread.h and core/files/folders.h.
std::vector<std::string> find_throwing_forms(const std::string& path, std::string_view source);

}  // namespace trocar::architecture
