#include "results/reasons.h"

#include "results/detail/details_json.h"
#include "results/detail/rows.h"

namespace trocar::results {

Result<std::map<std::int64_t, Reasons>> list_reasons(Repository& repository, std::string_view person_id,
                                                     std::int64_t first, std::int64_t last) {
  using Found = std::map<std::int64_t, Reasons>;
  return repository.database().run("the attempts cannot be read", [&](soci::session& session) {
    Found found;
    const std::string person(person_id);
    const long long low = first, high = last;
    long long sequence = 0;
    std::string verdict;
    AttemptRecord record;
    soci::statement select =
        (session.prepare << "SELECT a.sequence, a.id, d.verdict FROM attempts a JOIN attempt_details d"
                            " ON d.sequence = a.sequence WHERE a.person_id = :p AND a.is_passed = 0"
                            " AND a.sequence >= :l AND a.sequence <= :h",
         soci::use(person), soci::use(low), soci::use(high), soci::into(sequence), soci::into(record.attempt.id),
         soci::into(verdict));
    select.execute();
    while (select.fetch()) {
      record.not_scored.clear();
      record.fails.clear();
      record.hints.clear();
      // One damaged attempt must not hide the others.
      if (const Status read = detail::read_verdict(verdict, record); !read)
        record.fails = {read.error().what + ": " + read.error().advice};
      found[sequence] = {record.not_scored, record.fails};
    }
    return found;
  });
}

}  // namespace trocar::results
