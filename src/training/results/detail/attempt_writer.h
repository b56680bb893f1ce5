#pragma once

#include <soci/soci.h>

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "database/database.h"
#include "results/attempt.h"
#include "results/detail/attempt_query.h"

namespace trocar::results::detail {

/// A writing statement that is prepared at its first execution and executed again with other values. `Values`: types of
/// its parameters, in their order; Bound<T> for one that may be NULL. Its session outlives it. Not for a connection
/// that is made again.
template <class... Values>
class Prepared {
 public:
  Prepared(soci::session& session, std::string text) : session_(session), text_(std::move(text)) {}
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;

  /// Returns the number of rows that it has changed. Throws soci::soci_error.
  long long execute(Values... values) {
    if (!statement_) {
      statement_.emplace(session_);
      std::apply([this](auto&... bound) { (use(bound), ...); }, bound_);
      statement_->alloc();
      statement_->prepare(text_);
      statement_->define_and_bind();
    }
    bound_ = std::tuple<Values...>(std::move(values)...);
    statement_->execute(true);
    return statement_->get_affected_rows();
  }

 private:
  template <class T>
  void use(T& value) {
    statement_->exchange(soci::use(value));
  }
  template <class T>
  void use(Bound<T>& value) {
    statement_->exchange(soci::use(value.value, value.indicator));
  }

  soci::session& session_;
  std::string text_;
  std::tuple<Values...> bound_;
  std::optional<soci::statement> statement_;
};

/// Error: what neither a CSV file nor every database can keep: an id that is none, no task, a level that is unknown, a
/// text that is not UTF-8 or has a NUL byte, a name of a part or a metric that no column can have. `where` names the
/// column.
Status check_storable(const Attempt& attempt);
Status check_storable(const AttemptRecord& record);

/// Writes attempts within a transaction; its functions throw soci::soci_error. It may live as long as the transaction:
/// statements are prepared, and keys of cases, metrics and people found, once.
class AttemptWriter {
 public:
  AttemptWriter(soci::session& session, const database::Database& database);

  /// Adds the attempt's row as running if there is none of its id. Errors: no such person (exit status 2), those of
  /// check_storable.
  Status begin(const Attempt& attempt);
  struct Recorded {
    std::int64_t sequence = 0;
    bool is_written = false;  ///< False: it had ended already.
  };
  /// Completes an attempt that has not ended, or adds it.
  Result<Recorded> record(const AttemptRecord& record, std::string_view recording);
  /// Adds an attempt of a table without path and recording, or completes one of which the database knows less (running
  /// before interrupted before ended), and keeps its path and recording. Returns its state; empty: nothing to write.
  Result<std::optional<State>> merge(const AttemptRecord& record);

 private:
  struct Row {
    long long sequence = 0;
    State state = State::kRunning;
    bool is_new = false;  ///< Added by this call.
  };
  /// The row of the attempt, locked; added with the values of `attempt` if there is none.
  Result<Row> add_or_lock(const Attempt& attempt);
  long long case_key(const Case& the_case);
  long long metric_key(const Measure& measure);
  bool is_person(const std::string& id);
  void update_row(long long sequence, const Attempt& settled);
  void replace_texts(const Row& row, const AttemptRecord& record);
  void replace_values(const Row& row, const AttemptRecord& record);
  void replace_recording(const Row& row, std::string_view recording);

  soci::session& session_;
  const database::Database& database_;
  std::map<std::string, long long, std::less<>> metric_keys_, case_keys_;
  std::set<std::string> people_;
  /// Sequence and state by id.
  struct Find {
    std::string id;
    long long sequence = 0;
    int state = 0;
    std::optional<soci::statement> statement;
  } find_;
  Prepared<std::string, std::string, long long, std::string, std::string, std::string, std::string, long long, int,
           Bound<double>, int, double, std::string>
      add_;
  Prepared<long long, std::string, std::string> add_details_;
  Prepared<long long, std::string, double, double, std::string> add_part_;
  Prepared<long long, long long, double> add_metric_;
};

}  // namespace trocar::results::detail
