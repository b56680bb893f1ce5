#pragma once

#include <map>
#include <string>
#include <vector>

namespace trocar::architecture {

/// Text of all C++ files in some folders of the repository, by their path in it.
std::map<std::string, std::string> source_files(const std::vector<std::string>& folders);

/// True for a character of a name or number.
bool is_word(char c);

/// Joins complaints, one line each.
std::string joined(const std::vector<std::string>& complaints);

}  // namespace trocar::architecture
