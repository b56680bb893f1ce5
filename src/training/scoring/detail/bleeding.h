#pragma once

#include "scoring/detail/judgement.h"

namespace trocar::scoring {

/// How likely the punctured organ bleeds, by what was done to it; empty for a task whose target is a fluid
/// (tasks::Task::min_organ_path_mm is 0). High with a vessel touched, or two of the following; raised with one of them:
/// many punctures of the organ's surface, a channel with too little organ around it to close.
std::optional<Bleeding> judge_bleeding(const Judgement& judged);

}  // namespace trocar::scoring
