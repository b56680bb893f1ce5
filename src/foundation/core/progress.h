#pragma once

#include <functional>
#include <string_view>

namespace trocar {
inline namespace core {

/// Callback of a long task: present step, and progress in 0..1. May be empty.
using Progress = std::function<void(std::string_view step, double fraction)>;

/// Calls `progress` unless it is empty.
inline void report(const Progress& progress, std::string_view step, double fraction) {
  if (progress) progress(step, fraction);
}

}  // namespace core
}  // namespace trocar
