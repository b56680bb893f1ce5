#pragma once

#include <string_view>

namespace trocar::io::detail {

/// Hash of the sources that generate patients and of the compiler with its options (cmake/patient_maker.cmake): equal
/// in all programs of a build.
std::string_view maker_version() noexcept;

}  // namespace trocar::io::detail
