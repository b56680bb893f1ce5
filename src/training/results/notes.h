#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "results/attempts.h"
#include "results/people.h"
#include "results/repository.h"

namespace trocar::results {

inline constexpr std::size_t kMaxNoteCharacters = 2000;

/// A remark of an instructor about one attempt. It is deleted with the attempt, and so with the person.
struct Note {
  std::string id;
  std::string attempt_id;
  std::string author;  ///< Name of the account at the time of writing.
  std::string text;
  Seconds written{};
};

/// Errors (exit status 2): no such attempt, an empty text, more than kMaxNoteCharacters, control characters.
Result<Note> add_note(Repository& repository, std::string_view attempt_id, std::string_view author,
                      std::string_view text, Seconds now);
/// Notes of an attempt, the oldest first.
Result<std::vector<Note>> list_notes(Repository& repository, std::string_view attempt_id);
Result<std::optional<Note>> find_note(Repository& repository, std::string_view id);
/// Error (exit status 2): no such note. In an SQLite file the freed bytes are overwritten, and its log is emptied.
Status delete_note(Repository& repository, std::string_view id);
/// How many notes the attempts of a person have, by the attempt's sequence; only attempts with notes.
Result<std::map<std::int64_t, std::int64_t>> count_notes(Repository& repository, std::string_view person_id);
/// One row a note: attempt, person, course, task, started_utc, written_utc, author, note. RFC 4180; see csv_text.
Result<std::string> notes_csv(Repository& repository, const AttemptFilter& filter);

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
