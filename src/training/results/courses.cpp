#include "results/courses.h"

#include "results/detail/people_table.h"
#include "results/detail/rows.h"

namespace trocar::results {
using namespace detail;
namespace {

constexpr const char* kCannotWriteCourse = "the course cannot be written";
constexpr const char* kCourseName = "the name of a course";

Status no_such_course(std::string_view name) {
  return fail_usage("no such course", std::string(name), "reload the list of courses");
}

/// Empty: there is none.
std::string find_course_id(soci::session& session, const std::string& key) {
  std::string id;
  session << "SELECT id FROM courses WHERE name_key = :k", soci::use(key), soci::into(id);
  return session.got_data() ? id : std::string();
}

}  // namespace

Status rename_course(Repository& repository, std::string_view name, std::string_view new_name) {
  TROCAR_TRY(const std::string clean, clean_name(new_name, kCourseName));
  return repository.database().transaction(kCannotWriteCourse, [&](soci::session& session) -> Status {
    const std::string id = find_course_id(session, name_key(name)), key = name_key(clean);
    if (id.empty()) return no_such_course(name);
    const std::string other = find_course_id(session, key);
    if (!other.empty() && other != id) return fail_usage("the name is taken", clean, "choose another name");
    session << "UPDATE courses SET name = :n, name_key = :k WHERE id = :i", soci::use(clean), soci::use(key),
        soci::use(id);
    return {};
  });
}

Status remove_empty_course(Repository& repository, std::string_view name) {
  return repository.database().transaction(kCannotWriteCourse, [&](soci::session& session) -> Status {
    const std::string id = find_course_id(session, name_key(name));
    if (id.empty()) return no_such_course(name);
    std::string locked;
    // A person who is added to it at the same time must be seen.
    if (!repository.database().is_sqlite())
      session << "SELECT id FROM courses WHERE id = :i FOR UPDATE", soci::use(id), soci::into(locked);
    soci::statement remove = (session.prepare << "DELETE FROM courses WHERE id = :i AND NOT EXISTS"
                                                 " (SELECT 1 FROM people p WHERE p.course_id = courses.id)",
                              soci::use(id));
    remove.execute(true);
    if (remove.get_affected_rows() == 1) return {};
    return fail_usage("the course has people", std::string(name), "move them to another course first");
  });
}

Status change_person(Repository& repository, std::string_view id, const PersonChange& change) {
  return repository.database().transaction(kCannotWritePerson, [&](soci::session& session) -> Status {
    const std::string person(id);
    if (!detail::find_person(session, person)) return no_such_person(person);
    if (change.name) TROCAR_TRY_STATUS(detail::rename_person(session, person, *change.name));
    if (change.course) TROCAR_TRY_STATUS(detail::move_to_course(session, person, *change.course));
    if (change.group) {
      const int is_expert = *change.group == Group::kExpert ? 1 : 0;
      session << "UPDATE people SET is_expert = :e WHERE id = :i", soci::use(is_expert), soci::use(person);
    }
    return {};
  });
}

Status move_people(Repository& repository, const std::vector<std::string>& ids, std::string_view course) {
  return repository.database().transaction(kCannotWritePerson, [&](soci::session& session) -> Status {
    for (const std::string& id : ids) TROCAR_TRY_STATUS(detail::move_to_course(session, id, course));
    return {};
  });
}

}  // namespace trocar::results
