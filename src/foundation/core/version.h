#pragma once

namespace trocar {
inline namespace core {

/// The program's version, as recorded in sessions and patients.
inline constexpr const char* kVersion = "0.1.0";

}  // namespace core
}  // namespace trocar
