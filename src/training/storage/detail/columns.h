#pragma once

#include <type_traits>

#include "telemetry/tick_fields.h"

namespace trocar::storage::detail {

/// Calls visit(name, field) for every column of `trocar session export --csv`, in its order; see
/// telemetry::for_each_column. `Sample` is TickSample or const TickSample.
template <class Sample, class Visitor>
void visit_columns(Sample& sample, Visitor&& visit) {
  telemetry::for_each_tick_field(
      [&]<class Value, telemetry::TickUse use>(const telemetry::TickField<Value, use>& field) {
        if constexpr (use.is_in_csv) telemetry::for_each_column(sample, field, visit);
      });
}

/// The columns of the `ticks` table: every field but the events, which have a table of their own.
template <class Sample, class Visitor>
void visit_stored_columns(Sample& sample, Visitor&& visit) {
  telemetry::for_each_tick_field(
      [&]<class Value, telemetry::TickUse use>(const telemetry::TickField<Value, use>& field) {
        if constexpr (!std::is_same_v<Value, telemetry::TickEvents>) telemetry::for_each_column(sample, field, visit);
      });
}

/// True if a visited field is kept as a real number (else as an integer).
template <class Field>
inline constexpr bool kIsReal = std::is_same_v<std::remove_const_t<Field>, double>;

}  // namespace trocar::storage::detail
