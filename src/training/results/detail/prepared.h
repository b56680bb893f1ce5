#pragma once

#include <soci/soci.h>

#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "results/detail/rows.h"

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

}  // namespace trocar::results::detail
