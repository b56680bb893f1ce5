#pragma once

#include <span>
#include <vector>

#include "scoring/detail/judgement.h"

namespace trocar::scoring {

/// Advice for improvement in the words of an instructor, the costliest first, with the moment to look at; praise if
/// there is nothing to improve. No advice contradicts another: what was too deep is not also to be pulled back less.
std::vector<Hint> make_hints(const Judgement& judged, std::span<const ScorePart> parts);

}  // namespace trocar::scoring
