#pragma once

#include <soci/soci.h>

#include <optional>
#include <string>

#include "results/people.h"

namespace trocar::results::detail {

inline constexpr const char* kCannotWritePerson = "the person cannot be written";

/// Parts of a larger transaction; see people.h. They throw soci::soci_error.
Result<Person> add_person(soci::session& session, const NewPerson& person, Seconds now);
/// Finds the person that another program adds at the same time, too.
Result<PersonOfName> find_or_add_person(soci::session& session, const NewPerson& person, Seconds now);
std::optional<Person> find_person(soci::session& session, const std::string& id);
std::optional<Person> find_person_named(soci::session& session, const std::string& key);
Status rename_person(soci::session& session, const std::string& id, std::string_view name);
Status move_to_course(soci::session& session, const std::string& id, std::string_view course);
PersonalData count_personal_data(soci::session& session, const std::string& id);
Result<PersonalData> delete_person(soci::session& session, const std::string& id, bool is_sqlite);
Status no_such_person(const std::string& id);

}  // namespace trocar::results::detail
