#pragma once

#include <soci/soci.h>

#include <optional>
#include <string>
#include <vector>

#include "results/attempts.h"
#include "results/people.h"

namespace trocar::results::detail {

inline constexpr const char* kCannotReadAttempts = "the attempts cannot be read";

/// A condition on rows of `attempts` ("a") with its parameters, texts before numbers.
struct AttemptQuery {
  std::string condition;  ///< " WHERE …", without order.
  std::vector<std::string> texts;
  std::vector<long long> numbers;

  void bind(soci::statement& statement) const;  ///< The query outlives the statement.
};

/// All of a filter but its order and limit.
AttemptQuery make_query(const AttemptFilter& filter);

/// `order`: " ORDER BY …". Throws soci::soci_error.
std::vector<Attempt> read_attempts(soci::session& session, const AttemptQuery& query, const std::string& order = {});

/// A column that may be NULL, for soci::into: `Nullable<double> score; … into(score.value, score.indicator)`.
template <class T>
struct Nullable {
  T value{};
  soci::indicator indicator = soci::i_null;

  std::optional<T> get() const { return indicator == soci::i_ok ? std::optional<T>(value) : std::nullopt; }
};

/// A value for soci::use that is NULL if it is empty. Outlives the statement.
template <class T>
struct Bound {
  Bound() : Bound(std::nullopt) {}
  explicit Bound(const std::optional<T>& from)
      : value(from.value_or(T{})), indicator(from ? soci::i_ok : soci::i_null) {}

  T value;
  soci::indicator indicator;
};

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

/// Changes the key of results::last_deletion, within the transaction of a deletion. Throws soci::soci_error.
void note_deletion(soci::session& session);

}  // namespace trocar::results::detail
