#pragma once

#include <filesystem>

namespace trocar::testing {

/// Source folder of the checkout that the tests were built from. Defined by tests/source_dir.cpp, which every test
/// program links.
std::filesystem::path source_dir();

}  // namespace trocar::testing
