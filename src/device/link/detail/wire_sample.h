#pragma once

#include <array>
#include <cstddef>
#include <tuple>
#include <utility>

#include "link/detail/inspection.h"
#include "link/detail/messages_generated.h"
#include "telemetry/tick_fields.h"
#include "telemetry/tick_sample.h"

namespace trocar::link::detail {

/// Copies every field bit by bit, including NaN. `packed` may be uninitialised memory.
void write_sample(const telemetry::TickSample& sample, wire::Sample& packed) noexcept;
inline wire::Sample to_wire(const telemetry::TickSample& sample) noexcept {
  wire::Sample packed;
  write_sample(sample, packed);
  return packed;
}
/// Reads every field into `sample`. The inspection gets an error unless time, needle and device are finite and phase,
/// gate and events have known values. All other numbers are unchanged, because the record of a fault must contain them.
/// `sample` is a parameter instead of a result because a batch has hundreds of samples.
void read_sample(const wire::Sample& packed, Inspection& inspection, telemetry::TickSample& sample);

/// Bytes of a field in wire::Sample, and whether they are doubles.
struct WireField {
  std::size_t bytes = 0;
  bool is_real = false;
};

template <class Value>
inline constexpr WireField kWireField{1, false};  ///< tissue, bool, the enumerations
template <>
inline constexpr WireField kWireField<double>{sizeof(double), true};
template <>
inline constexpr WireField kWireField<Vec3>{3 * sizeof(double), true};
template <>
inline constexpr WireField kWireField<telemetry::Quaternion>{4 * sizeof(double), true};
template <>
inline constexpr WireField kWireField<telemetry::TickEvents>{
    std::tuple_size_v<telemetry::TickEvents> * sizeof(wire::Event), false};

template <std::size_t index>
inline constexpr WireField kWireFieldAt =
    kWireField<typename std::tuple_element_t<index, decltype(telemetry::kTickFields)>::Value>;

/// Offsets of the fields of kTickFields in wire::Sample, in bytes: the fields of doubles first, then the others, so
/// that the only padding is at the end. messages.fbs lists them in this order; wire_sample_test compares names, types
/// and offsets with the schema.
inline constexpr auto kWireOffsets = []<std::size_t... I>(std::index_sequence<I...>) {
  constexpr std::array fields{kWireFieldAt<I>...};
  std::array<std::size_t, sizeof...(I)> offsets{};
  std::size_t next = 0;
  for (const bool is_real : {true, false}) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (fields[i].is_real != is_real) continue;
      offsets[i] = next;
      next += fields[i].bytes;
    }
  }
  return offsets;
}
(std::make_index_sequence<telemetry::kTickFieldCount>());

/// Bytes of all fields, without the padding at the end.
inline constexpr std::size_t kWireBytes = []<std::size_t... I>(std::index_sequence<I...>) {
  return (kWireFieldAt<I>.bytes + ...);
}
(std::make_index_sequence<telemetry::kTickFieldCount>());
static_assert(kWireBytes <= sizeof(wire::Sample) && kWireBytes + alignof(wire::Sample) > sizeof(wire::Sample),
              "struct Sample of messages.fbs has the fields of kTickFields");

/// Calls visit(field, offset) for every field of kTickFields.
template <class Visitor>
constexpr void for_each_wire_field(Visitor&& visit) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (visit(std::get<I>(telemetry::kTickFields), kWireOffsets[I]), ...);
  }
  (std::make_index_sequence<telemetry::kTickFieldCount>());
}

}  // namespace trocar::link::detail
