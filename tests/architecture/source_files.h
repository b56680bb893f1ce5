#pragma once

#include <map>
#include <string>
#include <vector>

namespace trocar::architecture {

/// All C++ files of some folders of the repository, by their path in it, with their text.
std::map<std::string, std::string> source_files(const std::vector<std::string>& folders);

/// Complaints, a line each.
std::string joined(const std::vector<std::string>& complaints);

}  // namespace trocar::architecture
