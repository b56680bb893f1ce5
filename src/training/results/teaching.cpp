#include "results/teaching.h"

#include <fmt/format.h>

#include "results/detail/people_table.h"
#include "results/detail/rows.h"

namespace trocar::results {

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

}  // namespace trocar::results
