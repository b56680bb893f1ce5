#pragma once

namespace trocar {
inline namespace core {

/// Adds to the niceness of the calling thread, if the system has one per thread (Linux). A failure is ignored.
void lower_priority(int nice) noexcept;

}  // namespace core
}  // namespace trocar
