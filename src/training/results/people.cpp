#include "results/people.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "results/detail/attempt_query.h"
#include "results/repository.h"
#include "signing/password.h"

namespace trocar::results {
using namespace detail;
namespace {

constexpr const char* kCannotReadPeople = "the people cannot be read";
constexpr const char* kPersonName = "the name of a person";
constexpr const char* kSelectPeople =
    "SELECT p.id, p.name, p.is_expert, coalesce(c.name, ''), p.is_simulated, p.pin_hash, p.added_s"
    " FROM people p LEFT JOIN courses c ON c.id = p.course_id";

/// Reads all people of a query; `use` binds its parameter, if it has one.
std::vector<Person> read_people(soci::session& session, const std::string& condition, const std::string* parameter) {
  std::vector<Person> people;
  Person person;
  int is_expert = 0, is_simulated = 0;
  std::string pin_hash;
  long long added_s = 0;
  soci::statement select(session);
  select.exchange(soci::into(person.id));
  select.exchange(soci::into(person.name));
  select.exchange(soci::into(is_expert));
  select.exchange(soci::into(person.course));
  select.exchange(soci::into(is_simulated));
  select.exchange(soci::into(pin_hash));
  select.exchange(soci::into(added_s));
  if (parameter != nullptr) select.exchange(soci::use(*parameter));
  select.alloc();
  select.prepare(std::string(kSelectPeople) + condition + " ORDER BY p.name_key");
  select.define_and_bind();
  select.execute();
  while (select.fetch()) {
    person.group = is_expert != 0 ? Group::kExpert : Group::kTrainee;
    person.is_simulated = is_simulated != 0;
    person.has_pin = !pin_hash.empty();
    person.added = Seconds(std::chrono::seconds(added_s));
    people.push_back(person);
  }
  return people;
}

/// No name stands for no course.
Result<std::string> clean_course(std::string_view name) {
  return name.empty() ? Result<std::string>(std::string()) : clean_name(name, "the name of a course");
}

std::optional<Person> first_of(std::vector<Person> people) {
  return people.empty() ? std::nullopt : std::optional(std::move(people.front()));
}

/// The course's id, made if it is new; empty without a name.
std::optional<std::string> course_id(soci::session& session, const std::string& name) {
  if (name.empty()) return std::nullopt;
  const std::string key = name_key(name), new_id = make_id();
  // An update of nothing locks the row: a deletion at the same time must not take it for an empty course.
  session << "INSERT INTO courses (id, name, name_key) VALUES (:i, :n, :k)"
             " ON CONFLICT (name_key) DO UPDATE SET name_key = excluded.name_key",
      soci::use(new_id), soci::use(name), soci::use(key);
  std::string id;
  session << "SELECT id FROM courses WHERE name_key = :k", soci::use(key), soci::into(id);
  return id;
}

/// Deletes the courses that nobody is in. Their rows are locked first, so that people who are added to one of them at
/// the same time are seen.
void remove_empty_courses(soci::session& session, bool is_sqlite) {
  if (!is_sqlite) session << "SELECT count(*) FROM (SELECT id FROM courses ORDER BY id FOR UPDATE) locked";
  session << "DELETE FROM courses WHERE NOT EXISTS (SELECT 1 FROM people p WHERE p.course_id = courses.id)";
}

bool is_name_taken(soci::session& session, const std::string& key, const std::string& but_id) {
  int count = 0;
  session << "SELECT count(*) FROM people WHERE name_key = :k AND id <> :i", soci::use(key), soci::use(but_id),
      soci::into(count);
  return count > 0;
}

/// Sets one column of a person. Error: there is none.
template <class Value>
Status set_column(Repository& repository, std::string_view id, const char* column, const Value& value) {
  return repository.database().transaction(kCannotWritePerson, [&](soci::session& session) -> Status {
    const std::string key(id);
    soci::statement update = (session.prepare << fmt::format("UPDATE people SET {} = :v WHERE id = :i", column),
                              soci::use(value), soci::use(key));
    update.execute(true);
    return update.get_affected_rows() == 1 ? Status() : no_such_person(key);
  });
}

/// Waiting time after `failures` wrong PINs in a row.
std::int64_t pin_delay_s(int failures) {
  constexpr std::int64_t kFirst_s = 30, kLongest_s = 3600;
  if (failures < kFreePinTries) return 0;
  const int doublings = std::min(failures - kFreePinTries, 10);
  return std::min(kLongest_s, kFirst_s << doublings);
}

}  // namespace

const char* to_string(Group group) noexcept {
  return group == Group::kExpert ? "expert" : "trainee";
}

std::optional<Group> find_group(std::string_view name) noexcept {
  for (const Group group : {Group::kTrainee, Group::kExpert})
    if (name == to_string(group)) return group;
  return std::nullopt;
}

namespace detail {

Status no_such_person(const std::string& id) {
  return fail_usage("no such person", id, "see trocar results people");
}

Result<Person> add_person(soci::session& session, const NewPerson& person, Seconds now) {
  TROCAR_TRY(std::string name, clean_name(person.name, kPersonName));
  TROCAR_TRY(std::string course, clean_course(person.course));
  Person added{person.id.empty() ? make_id() : person.id,
               std::move(name),
               person.group,
               std::move(course),
               person.is_simulated,
               false,
               now};
  const std::string key = name_key(added.name);
  if (is_name_taken(session, key, "")) return fail_usage("the name is taken", added.name, "choose another name");
  Bound<std::string> course_key(course_id(session, added.course));
  const int is_expert = added.group == Group::kExpert ? 1 : 0, is_simulated = added.is_simulated ? 1 : 0;
  const long long now_s = now.time_since_epoch().count();
  soci::statement insert =
      (session.prepare
           << "INSERT INTO people (id, name, name_key, is_expert, is_simulated, course_id, pin_hash, pin_failures,"
              " pin_failed_s, added_s) VALUES (:id, :name, :key, :expert, :simulated, :course, '', 0, 0, :now)"
              " ON CONFLICT (name_key) DO NOTHING",
       soci::use(added.id), soci::use(added.name), soci::use(key), soci::use(is_expert), soci::use(is_simulated),
       soci::use(course_key.value, course_key.indicator), soci::use(now_s));
  insert.execute(true);
  if (insert.get_affected_rows() != 1) return fail_usage("the name is taken", added.name, "choose another name");
  return added;
}

std::optional<Person> find_person(soci::session& session, const std::string& id) {
  return first_of(read_people(session, " WHERE p.id = :i", &id));
}

std::optional<Person> find_person_named(soci::session& session, const std::string& key) {
  return first_of(read_people(session, " WHERE p.name_key = :k", &key));
}

Result<PersonOfName> find_or_add_person(soci::session& session, const NewPerson& person, Seconds now) {
  TROCAR_TRY(const std::string name, clean_name(person.name, kPersonName));
  const std::string key = name_key(name);
  if (auto found = find_person_named(session, key)) return PersonOfName{*std::move(found), false};
  auto added = add_person(session, person, now);
  if (added) return PersonOfName{*std::move(added), true};
  // Another program may have added the name since.
  if (auto found = find_person_named(session, key)) return PersonOfName{*std::move(found), false};
  return tl::unexpected(added.error());
}

Status rename_person(soci::session& session, const std::string& id, std::string_view name) {
  TROCAR_TRY(const std::string clean, clean_name(name, kPersonName));
  const std::string key = name_key(clean);
  if (is_name_taken(session, key, id)) return fail_usage("the name is taken", clean, "choose another name");
  soci::statement update = (session.prepare << "UPDATE people SET name = :n, name_key = :k WHERE id = :i",
                            soci::use(clean), soci::use(key), soci::use(id));
  update.execute(true);
  return update.get_affected_rows() == 1 ? Status() : no_such_person(id);
}

Status move_to_course(soci::session& session, const std::string& id, std::string_view course) {
  TROCAR_TRY(const std::string clean, clean_course(course));
  Bound<std::string> key(course_id(session, clean));
  soci::statement update = (session.prepare << "UPDATE people SET course_id = :c WHERE id = :i",
                            soci::use(key.value, key.indicator), soci::use(id));
  update.execute(true);
  return update.get_affected_rows() == 1 ? Status() : no_such_person(id);
}

}  // namespace detail

Result<Person> add_person(Repository& repository, const NewPerson& person, Seconds now) {
  return repository.database().transaction(
      kCannotWritePerson, [&](soci::session& session) { return detail::add_person(session, person, now); });
}

Result<PersonOfName> find_or_add_person(Repository& repository, const NewPerson& person, Seconds now) {
  TROCAR_TRY(const std::string name, clean_name(person.name, kPersonName));
  return repository.database().transaction(kCannotWritePerson, [&](soci::session& session) -> Result<PersonOfName> {
    return detail::find_or_add_person(session, person, now);
  });
}

Result<std::vector<Person>> list_people(Repository& repository) {
  return repository.database().run(kCannotReadPeople,
                                   [](soci::session& session) { return read_people(session, "", nullptr); });
}

Result<std::optional<Person>> find_person(Repository& repository, std::string_view id) {
  return repository.database().run(
      kCannotReadPeople, [&](soci::session& session) { return detail::find_person(session, std::string(id)); });
}

Result<std::optional<Person>> find_person_named(Repository& repository, std::string_view name) {
  const auto clean = clean_name(name, kPersonName);
  if (!clean) return std::optional<Person>();
  return repository.database().run(
      kCannotReadPeople, [&](soci::session& session) { return detail::find_person_named(session, name_key(*clean)); });
}

Result<Person> get_person_named(Repository& repository, std::string_view name) {
  TROCAR_TRY(std::optional<Person> person, find_person_named(repository, name));
  if (person) return *std::move(person);
  return fail_usage("no such person", std::string(name),
                    "see trocar results people, or add one with trocar results add");
}

Status rename_person(Repository& repository, std::string_view id, std::string_view name) {
  return repository.database().transaction(kCannotWritePerson, [&](soci::session& session) {
    return detail::rename_person(session, std::string(id), name);
  });
}

Status move_to_course(Repository& repository, std::string_view id, std::string_view course) {
  return repository.database().transaction(kCannotWritePerson, [&](soci::session& session) {
    return detail::move_to_course(session, std::string(id), course);
  });
}

Status change_group(Repository& repository, std::string_view id, Group group) {
  return set_column(repository, id, "is_expert", group == Group::kExpert ? 1 : 0);
}

Result<PersonalData> count_personal_data(Repository& repository, std::string_view id) {
  return repository.database().run(
      kCannotReadPeople, [&](soci::session& session) { return detail::count_personal_data(session, std::string(id)); });
}

namespace detail {

PersonalData count_personal_data(soci::session& session, const std::string& id) {
  const auto count = [&](const char* query) {
    long long n = 0;
    session << query, soci::use(id), soci::into(n);
    return static_cast<std::int64_t>(n);
  };
  return {count("SELECT count(*) FROM attempts WHERE person_id = :i"),
          count("SELECT count(*) FROM recordings r JOIN attempts a ON a.sequence = r.sequence WHERE a.person_id = :i"),
          count("SELECT count(*) FROM responses WHERE person_id = :i")};
}

Result<PersonalData> delete_person(soci::session& session, const std::string& id, bool is_sqlite) {
  const PersonalData data = count_personal_data(session, id);
  soci::statement remove = (session.prepare << "DELETE FROM people WHERE id = :i", soci::use(id));
  remove.execute(true);
  if (remove.get_affected_rows() != 1) return tl::unexpected(no_such_person(id).error());
  remove_empty_courses(session, is_sqlite);
  note_deletion(session);
  return data;
}

}  // namespace detail

Result<PersonalData> delete_person(Repository& repository, std::string_view id) {
  database::Database& database = repository.database();
  TROCAR_TRY(PersonalData data,
             database.transaction("the person cannot be deleted", [&](soci::session& session) -> Result<PersonalData> {
               return detail::delete_person(session, std::string(id), database.is_sqlite());
             }));
  data.is_erased = erase_deleted(repository).value_or(false);
  return data;
}

Status set_pin(Repository& repository, std::string_view id, std::string_view pin) {
  std::string hash;
  if (!pin.empty()) {
    TROCAR_TRY_STATUS(signing::check_new_pin(pin));
    TROCAR_TRY(hash, signing::hash_password(pin));
  }
  TROCAR_TRY_STATUS(set_column(repository, id, "pin_failures", 0));
  return set_column(repository, id, "pin_hash", hash);
}

Result<PinCheck> check_pin(Repository& repository, std::string_view id, std::string_view pin, Seconds now) {
  const std::string person(id);
  const long long now_s = now.time_since_epoch().count();
  std::string hash;
  int failures = 0;
  long long failed_s = 0;
  // The try is counted before it is checked, so that tries at the same time are all counted.
  TROCAR_TRY(const bool may_try,
             repository.database().transaction(kCannotWritePerson, [&](soci::session& session) -> Result<bool> {
               session << "SELECT pin_hash, pin_failures, pin_failed_s FROM people WHERE id = :i", soci::use(person),
                   soci::into(hash), soci::into(failures), soci::into(failed_s);
               if (!session.got_data()) return tl::unexpected(no_such_person(person).error());
               if (failed_s > now_s) {  // the clock was set back: the time of the last failure counts as now
                 failed_s = now_s;
                 session << "UPDATE people SET pin_failed_s = :n WHERE id = :i", soci::use(now_s), soci::use(person);
               }
               if (now_s - failed_s < pin_delay_s(failures)) return false;
               session << "UPDATE people SET pin_failures = pin_failures + 1, pin_failed_s = :n WHERE id = :i",
                   soci::use(now_s), soci::use(person);
               return true;
             }));
  if (!may_try) return PinCheck::kTooManyTries;
  if (!hash.empty() && !signing::is_password(hash, pin)) return PinCheck::kWrong;
  TROCAR_TRY_STATUS(set_column(repository, id, "pin_failures", 0));
  return PinCheck::kRight;
}

Result<bool> are_pins_required(Repository& repository) {
  return repository.database().run(kCannotReadPeople, [](soci::session& session) {
    std::string value;
    session << "SELECT value FROM settings WHERE name = 'pins_required'", soci::into(value);
    return session.got_data() && value == "1";
  });
}

Status require_pins(Repository& repository, bool are_required) {
  return repository.database().transaction("the setting cannot be written", [&](soci::session& session) {
    const std::string value = are_required ? "1" : "0";
    session << "DELETE FROM settings WHERE name = 'pins_required'";
    session << "INSERT INTO settings (name, value) VALUES ('pins_required', :v)", soci::use(value);
  });
}

Result<std::vector<Course>> list_courses(Repository& repository) {
  return repository.database().run(kCannotReadPeople, [](soci::session& session) {
    std::vector<Course> courses;
    std::string name;
    long long people = 0;
    soci::statement select =
        (session.prepare << "SELECT c.name, (SELECT count(*) FROM people p WHERE p.course_id = c.id) FROM courses c"
                            " ORDER BY c.name_key",
         soci::into(name), soci::into(people));
    select.execute();
    while (select.fetch()) courses.push_back({name, people});
    return courses;
  });
}

}  // namespace trocar::results
