#pragma once

#include <map>
#include <string>
#include <string_view>

#include "results/repository.h"

namespace trocar::results {

/// Minutes of one entry: more is a mistake.
inline constexpr double kLeastTeaching_min = 0.5, kMostTeaching_min = 600.0;

/// Notes that an instructor spent `minutes` with a person on a task: standing by, showing, talking. No program can know
/// it, so instructors enter it. Errors (exit status 2): no such person, minutes out of kLeast..kMostTeaching_min.
Status add_teaching(Repository& repository, std::string_view person_id, std::string_view task, double minutes,
                    Seconds now);

/// Takes the newest entry of a person and a task back; its minutes. Error (exit status 2): there is none.
Result<double> remove_last_teaching(Repository& repository, std::string_view person_id, std::string_view task);

/// Sum of the minutes at a task, by person; only people with entries.
Result<std::map<std::string, double>> teaching_minutes(Repository& repository, std::string_view task);

}  // namespace trocar::results
