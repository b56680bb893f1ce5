#include "results/notes.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "config/csv.h"
#include "results/detail/attempt_query.h"
#include "results/repository.h"

namespace trocar::results {
using namespace detail;
namespace {

constexpr const char* kCannotReadNotes = "the notes cannot be read";
constexpr const char* kCannotWriteNote = "the note cannot be written";
constexpr const char* kSelectNotes =
    "SELECT n.id, a.id, n.author, n.text, n.written_s FROM notes n JOIN attempts a ON a.sequence = n.sequence";

std::vector<Note> read_notes(soci::session& session, const char* condition, const std::string& key) {
  std::vector<Note> notes;
  Note note;
  long long written_s = 0;
  soci::statement select = (session.prepare << std::string(kSelectNotes) + condition + " ORDER BY n.number",
                            soci::use(key), soci::into(note.id), soci::into(note.attempt_id), soci::into(note.author),
                            soci::into(note.text), soci::into(written_s));
  select.execute();
  while (select.fetch()) {
    note.written = Seconds(std::chrono::seconds(written_s));
    notes.push_back(note);
  }
  return notes;
}

std::string time_text(long long utc_s) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(static_cast<std::time_t>(utc_s)));
}

}  // namespace

Result<Note> add_note(Repository& repository, std::string_view attempt_id, std::string_view author,
                      std::string_view text, Seconds now) {
  TROCAR_TRY(const std::string clean, clean_text(text, kMaxNoteCharacters, "the note"));
  if (clean.empty()) return fail_usage("the note is empty", {}, "write a text");
  return repository.database().transaction(kCannotWriteNote, [&](soci::session& session) -> Result<Note> {
    const Note note{make_id(), std::string(attempt_id), std::string(author), clean, now};
    long long sequence = 0;
    session << "SELECT sequence FROM attempts WHERE id = :i", soci::use(note.attempt_id), soci::into(sequence);
    if (!session.got_data()) return fail_usage("no such attempt", note.attempt_id, "see trocar results list");
    const long long now_s = now.time_since_epoch().count();
    session << "INSERT INTO notes (id, sequence, author, text, written_s) VALUES (:i, :s, :a, :t, :n)",
        soci::use(note.id), soci::use(sequence), soci::use(note.author), soci::use(note.text), soci::use(now_s);
    return note;
  });
}

Result<std::vector<Note>> list_notes(Repository& repository, std::string_view attempt_id) {
  return repository.database().run(kCannotReadNotes, [&](soci::session& session) {
    return read_notes(session, " WHERE a.id = :i", std::string(attempt_id));
  });
}

Result<std::optional<Note>> find_note(Repository& repository, std::string_view id) {
  return repository.database().run(kCannotReadNotes, [&](soci::session& session) -> std::optional<Note> {
    const std::vector<Note> found = read_notes(session, " WHERE n.id = :i", std::string(id));
    return found.empty() ? std::nullopt : std::optional(found.front());
  });
}

Status delete_note(Repository& repository, std::string_view id) {
  const auto deleted =
      repository.database().transaction("the note cannot be deleted", [&](soci::session& session) -> Status {
        const std::string key(id);
        soci::statement remove = (session.prepare << "DELETE FROM notes WHERE id = :i", soci::use(key));
        remove.execute(true);
        if (remove.get_affected_rows() != 1) return fail_usage("no such note", key, "reload the page");
        note_deletion(session);
        return {};
      });
  if (deleted) static_cast<void>(erase_deleted(repository));
  return deleted;
}

Result<std::map<std::int64_t, std::int64_t>> count_notes(Repository& repository, std::string_view person_id) {
  return repository.database().run(kCannotReadNotes, [&](soci::session& session) {
    std::map<std::int64_t, std::int64_t> counts;
    const std::string person(person_id);
    long long sequence = 0, count = 0;
    soci::statement select =
        (session.prepare << "SELECT n.sequence, count(*) FROM notes n JOIN attempts a ON a.sequence = n.sequence"
                            " WHERE a.person_id = :p GROUP BY n.sequence",
         soci::use(person), soci::into(sequence), soci::into(count));
    select.execute();
    while (select.fetch()) counts[sequence] = count;
    return counts;
  });
}

Result<std::string> notes_csv(Repository& repository, const AttemptFilter& filter) {
  const AttemptQuery query = make_query(filter);
  return repository.database().run(kCannotReadNotes, [&](soci::session& session) {
    std::string text =
        config::csv_row({"attempt", "person", "course", "task", "started_utc", "written_utc", "author", "note"});
    std::string attempt, person, course, task, author, note;
    long long started_s = 0, written_s = 0;
    soci::statement select(session);
    for (std::string* column : {&attempt, &person, &course, &task, &author, &note})
      select.exchange(soci::into(*column));
    select.exchange(soci::into(started_s));
    select.exchange(soci::into(written_s));
    query.bind(select);
    select.alloc();
    select.prepare(
        "SELECT a.id, p.name, coalesce(c.name, ''), a.task, n.author, n.text, a.started_s, n.written_s FROM notes n"
        " JOIN attempts a ON a.sequence = n.sequence JOIN people p ON p.id = a.person_id"
        " LEFT JOIN courses c ON c.id = p.course_id" +
        query.condition + " ORDER BY n.number");
    select.define_and_bind();
    select.execute();
    while (select.fetch())
      text += config::csv_row({attempt, config::csv_text(person), config::csv_text(course), config::csv_text(task),
                               time_text(started_s), time_text(written_s), config::csv_text(author),
                               config::csv_text(note)});
    return text;
  });
}

Status add_teaching(Repository& repository, std::string_view person_id, std::string_view task, double minutes,
                    Seconds now) {
  if (!(minutes >= kLeastTeaching_min && minutes <= kMostTeaching_min))
    return fail_usage(fmt::format("{:g} minutes of teaching are out of range", minutes), "minutes",
                      fmt::format("use {:g} to {:g}", kLeastTeaching_min, kMostTeaching_min));
  return repository.database().transaction("the minutes cannot be written", [&](soci::session& session) -> Status {
    const std::string person(person_id), name(task);
    if (!detail::find_person(session, person)) return detail::no_such_person(person);
    const long long now_s = now.time_since_epoch().count();
    session << "INSERT INTO teaching (person_id, task, minutes, entered_s) VALUES (:p, :t, :m, :n)", soci::use(person),
        soci::use(name), soci::use(minutes), soci::use(now_s);
    return {};
  });
}

Result<double> remove_last_teaching(Repository& repository, std::string_view person_id, std::string_view task) {
  return repository.database().transaction(
      "the minutes cannot be removed", [&](soci::session& session) -> Result<double> {
        const std::string person(person_id), name(task);
        long long sequence = 0;
        double minutes = 0.0;
        session << "SELECT sequence, minutes FROM teaching WHERE person_id = :p AND task = :t"
                   " ORDER BY sequence DESC LIMIT 1",
            soci::use(person), soci::use(name), soci::into(sequence), soci::into(minutes);
        if (!session.got_data()) return fail_usage("no minutes were entered", name, "see trocar results proficiency");
        session << "DELETE FROM teaching WHERE sequence = :s", soci::use(sequence);
        return minutes;
      });
}

Result<std::map<std::string, double>> teaching_minutes(Repository& repository, std::string_view task) {
  return repository.database().run("the minutes cannot be read", [&](soci::session& session) {
    std::map<std::string, double> found;
    const std::string name(task);
    std::string person;
    double minutes = 0.0;
    soci::statement select = (session.prepare << "SELECT person_id, sum(minutes) FROM teaching WHERE task = :t"
                                                 " GROUP BY person_id",
                              soci::use(name), soci::into(person), soci::into(minutes));
    select.execute();
    while (select.fetch()) found[person] = minutes;
    return found;
  });
}

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
