#pragma once

#include <soci/soci.h>

#include <optional>
#include <string>
#include <vector>

namespace trocar::results::detail {

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

}  // namespace trocar::results::detail
