#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "results/names.h"
#include "results/repository.h"

namespace trocar::results {

/// Whose attempts are compared with whose.
enum class Group : std::uint8_t { kTrainee, kExpert };
const char* to_string(Group group) noexcept;  ///< "trainee", "expert".
std::optional<Group> find_group(std::string_view name) noexcept;

struct Person {
  std::string id;  ///< make_id(); the only thing that a session file says about its trainee.
  std::string name;
  Group group = Group::kTrainee;
  std::string course;         ///< Name of the course; empty: none.
  bool is_simulated = false;  ///< A scripted operator; said wherever its results are shown.
  bool has_pin = false;
  Seconds added{};
};

struct NewPerson {
  std::string name;
  Group group = Group::kTrainee;
  std::string course = {};  ///< Made if there is none of this name.
  bool is_simulated = false;
  std::string id = {};  ///< Empty: a new one. Given: the person of another database.
};

/// Error (exit status 2): a name that cannot be used, or exists.
Result<Person> add_person(Repository& repository, const NewPerson& person, Seconds now);
/// The person of this name, as it is; added if there is none, also by another program at the same time.
struct PersonOfName {
  Person person;
  bool is_added = false;
};
Result<PersonOfName> find_or_add_person(Repository& repository, const NewPerson& person, Seconds now);
Result<std::vector<Person>> list_people(Repository& repository);  ///< By name.
Result<std::optional<Person>> find_person(Repository& repository, std::string_view id);
Result<std::optional<Person>> find_person_named(Repository& repository, std::string_view name);
/// The person of this name. Error (exit status 2): there is none, with names that are alike.
Result<Person> get_person_named(Repository& repository, std::string_view name);
Status rename_person(Repository& repository, std::string_view id, std::string_view name);
Status move_to_course(Repository& repository, std::string_view id, std::string_view course);
Status change_group(Repository& repository, std::string_view id, Group group);

/// What a deletion removes.
struct PersonalData {
  std::int64_t attempts = 0;
  std::int64_t recordings = 0;
  std::int64_t answers = 0;  ///< Filled-in questionnaires.
  bool is_erased = true;     ///< After a deletion: see erase_deleted.
};
Result<PersonalData> count_personal_data(Repository& repository, std::string_view id);
/// Deletes a person with attempts, recordings, notes and answers, permanently, and a course that nobody is in any more.
/// In an SQLite file the freed bytes are overwritten, and its log is emptied.
Result<PersonalData> delete_person(Repository& repository, std::string_view id);

/// Sets a PIN of 4 to 12 digits; empty: none from now on. Only its Argon2id hash is kept.
Status set_pin(Repository& repository, std::string_view id, std::string_view pin);
/// After kFreePinTries wrong ones in a row a further try is refused for a time that doubles, up to an hour.
enum class PinCheck : std::uint8_t { kRight, kWrong, kTooManyTries };
inline constexpr int kFreePinTries = 5;
Result<PinCheck> check_pin(Repository& repository, std::string_view id, std::string_view pin, Seconds now);
/// Whether everybody has to have a PIN; false in a new database.
Result<bool> are_pins_required(Repository& repository);
Status require_pins(Repository& repository, bool are_required);

struct Course {
  std::string name;
  std::int64_t people = 0;
};
Result<std::vector<Course>> list_courses(Repository& repository);  ///< By name.

}  // namespace trocar::results
