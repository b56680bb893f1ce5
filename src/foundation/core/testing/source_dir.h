#pragma once

#include <filesystem>

namespace trocar::testing {

/// Source folder of the checkout that the tests were built from. Defined by tests/source_dir.cpp, which every test
/// program links.
std::filesystem::path source_dir();

/// Folder of the libraries that stand in for those of devices, beside the test programs.
inline std::filesystem::path standin_dir() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "standin";
}

}  // namespace trocar::testing
