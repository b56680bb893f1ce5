#pragma once

#include "core/progress.h"

namespace trocar {
inline namespace core {

/// The part of a longer work that lies between two fractions of it, as its own progress.
inline Progress part_of(const Progress& whole, double from, double to) {
  return [=](std::string_view step, double fraction) { report(whole, step, from + (to - from) * fraction); };
}

}  // namespace core
}  // namespace trocar
