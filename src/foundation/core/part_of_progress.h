#pragma once

#include "core/progress.h"

namespace trocar {
inline namespace core {

/// Progress of one part of a longer task: maps 0..1 of the part to from..to of the whole.
inline Progress part_of(const Progress& whole, double from, double to) {
  return [=](std::string_view step, double fraction) { report(whole, step, from + (to - from) * fraction); };
}

}  // namespace core
}  // namespace trocar
