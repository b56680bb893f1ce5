#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "results/attempts.h"

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

}  // namespace trocar::results
