#pragma once

#include <string_view>

#include "results/people.h"

namespace trocar::results {

/// Error (exit status 2): no such course, a name that cannot be used, or that another course has.
Status rename_course(Repository& repository, std::string_view name, std::string_view new_name);
/// Error (exit status 2): no such course, or it has people.
Status remove_empty_course(Repository& repository, std::string_view name);

/// What changes of a person; empty members stay as they are.
struct PersonChange {
  std::optional<std::string> name = {};
  std::optional<Group> group = {};
  std::optional<std::string> course = {};  ///< Made if there is none of this name; "": no course.
};
/// All of it or nothing. Errors (exit status 2): no such person, a name that cannot be used or is taken.
Status change_person(Repository& repository, std::string_view id, const PersonChange& change);
/// Moves all of them or nobody; `course` as above. Error (exit status 2): no such person, a name that cannot be used.
Status move_people(Repository& repository, const std::vector<std::string>& ids, std::string_view course);

}  // namespace trocar::results
