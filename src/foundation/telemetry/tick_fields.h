#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>

#include "telemetry/tick_sample.h"

namespace trocar::telemetry {

/// Values of a field that the link accepts; link/detail/inspection.h defines the limits.
enum class TickLimit : std::uint8_t {
  kNone,      ///< Any value, including NaN: the record of a fault must contain it.
  kTime,      ///< Finite, within the range of a clock.
  kPosition,  ///< Finite, within a room.
  kAxis,      ///< Finite, a unit vector or zero.
};

/// Records that contain a field, apart from the session file and the link, which contain every field.
struct TickUse {
  bool is_in_csv = true;             ///< `trocar session export --csv`.
  bool is_in_flight_record = false;  ///< The file that a server writes after a fault.
};
inline constexpr TickUse kInFlightRecord{true, true};
inline constexpr TickUse kSessionOnly{false, false};

/// Columns of a field in tables: three for a vector, four for a quaternion, else one.
template <class Value>
inline constexpr std::size_t kColumnCount = 1;
template <>
inline constexpr std::size_t kColumnCount<Vec3> = 3;
template <>
inline constexpr std::size_t kColumnCount<Quaternion> = 4;  // and of Drivers, the same type

/// One field of TickSample.
template <class ValueType, TickUse tick_use = TickUse{}>
struct TickField {
  using Value = ValueType;
  static constexpr TickUse kUse = tick_use;

  Value TickSample::*member;
  const char* name;  ///< Name of the member, and of the field of `struct Sample` in link/messages.fbs.
  std::array<const char*, kColumnCount<Value>> columns;  ///< Column names in tables, with their unit.
  TickLimit limit = TickLimit::kNone;
};

/// Description of all fields of TickSample. Wire format, columns of session files, CSV and flight record are derived
/// from it. The fields have the order of the CSV's columns, on which scripts depend; the fields of session files only
/// follow.
inline constexpr std::tuple kTickFields{
    TickField<double, kInFlightRecord>{&TickSample::time_s, "time_s", {"time_s"}, TickLimit::kTime},
    TickField<Vec3, kInFlightRecord>{
        &TickSample::tip_mm, "tip_mm", {"tip_x_mm", "tip_y_mm", "tip_z_mm"}, TickLimit::kPosition},
    TickField<Vec3>{&TickSample::axis, "axis", {"axis_x", "axis_y", "axis_z"}, TickLimit::kAxis},
    TickField<double>{&TickSample::axial_velocity_mm_s, "axial_velocity_mm_s", {"axial_velocity_mm_s"}},
    TickField<double>{&TickSample::depth_mm, "depth_mm", {"depth_mm"}},
    TickField<std::uint8_t>{&TickSample::tissue, "tissue", {"tissue"}},
    TickField<InsertionPhase>{&TickSample::phase, "phase", {"phase"}},
    TickField<double>{&TickSample::layer_displacement_mm, "layer_displacement_mm", {"layer_displacement_mm"}},
    TickField<double>{&TickSample::f_prepuncture_n, "f_prepuncture_n", {"f_prepuncture_n"}},
    TickField<double>{&TickSample::f_friction_n, "f_friction_n", {"f_friction_n"}},
    TickField<double>{&TickSample::f_cutting_n, "f_cutting_n", {"f_cutting_n"}},
    TickField<Vec3>{
        &TickSample::f_constraint_n, "f_constraint_n", {"f_constraint_x_n", "f_constraint_y_n", "f_constraint_z_n"}},
    TickField<Vec3>{&TickSample::f_weight_n, "f_weight_n", {"f_weight_x_n", "f_weight_y_n", "f_weight_z_n"}},
    TickField<Vec3>{&TickSample::f_total_n, "f_total_n", {"f_total_x_n", "f_total_y_n", "f_total_z_n"}},
    TickField<Vec3>{&TickSample::tau_nmm, "tau_nmm", {"tau_x_nmm", "tau_y_nmm", "tau_z_nmm"}},
    TickField<TickEvents>{&TickSample::events, "events", {"event"}},
    TickField<bool>{&TickSample::limited, "limited", {"limited"}},
    TickField<double>{&TickSample::breathing, "breathing", {"breathing"}},
    TickField<Vec3>{
        &TickSample::f_tip_proxy_n, "f_tip_proxy_n", {"f_tip_proxy_x_n", "f_tip_proxy_y_n", "f_tip_proxy_z_n"}},
    TickField<double>{&TickSample::f_body_axial_n, "f_body_axial_n", {"f_body_axial_n"}},
    TickField<double>{&TickSample::f_stick_n, "f_stick_n", {"f_stick_n"}},
    TickField<Vec3>{
        &TickSample::device_mm, "device_mm", {"device_x_mm", "device_y_mm", "device_z_mm"}, TickLimit::kPosition},
    TickField<Vec3>{&TickSample::device_f_n, "device_f_n", {"device_f_x_n", "device_f_y_n", "device_f_z_n"}},
    TickField<Vec3>{
        &TickSample::device_tau_nmm, "device_tau_nmm", {"device_tau_x_nmm", "device_tau_y_nmm", "device_tau_z_nmm"}},
    TickField<GateMode, kInFlightRecord>{&TickSample::gate_mode, "gate_mode", {"gate_mode"}},
    TickField<GateFault, kInFlightRecord>{&TickSample::gate_fault, "gate_fault", {"gate_fault"}},
    TickField<double, kInFlightRecord>{&TickSample::gate_scale, "gate_scale", {"gate_scale"}},
    TickField<double, kInFlightRecord>{&TickSample::coupling_share, "coupling_share", {"coupling_share"}},
    TickField<Vec3>{&TickSample::rest_tip_mm,
                    "rest_tip_mm",
                    {"rest_tip_x_mm", "rest_tip_y_mm", "rest_tip_z_mm"},
                    TickLimit::kPosition},
    TickField<Vec3>{
        &TickSample::rest_axis, "rest_axis", {"rest_axis_x", "rest_axis_y", "rest_axis_z"}, TickLimit::kAxis},
    TickField<bool>{&TickSample::is_breath_held, "is_breath_held", {"breath_held"}},
    TickField<Drivers, kSessionOnly>{
        &TickSample::drivers, "drivers", {"driver_1", "driver_2", "driver_1_per_s", "driver_2_per_s"}},
    TickField<Quaternion, kSessionOnly>{&TickSample::device_rotation_wxyz,
                                        "device_rotation_wxyz",
                                        {"device_qw", "device_qx", "device_qy", "device_qz"}},
    TickField<Vec3, kSessionOnly>{
        &TickSample::contact_to_puncture_mm, "contact_to_puncture_mm", {"px_p_x_mm", "px_p_y_mm", "px_p_z_mm"}},
};
inline constexpr std::size_t kTickFieldCount = std::tuple_size_v<decltype(kTickFields)>;

/// The last enumerator of an enumeration among the fields: readers refuse numbers above it.
constexpr InsertionPhase last_of(InsertionPhase) noexcept {
  return kLastInsertionPhase;
}
constexpr EventKind last_of(EventKind) noexcept {
  return kLastEventKind;
}
constexpr GateMode last_of(GateMode) noexcept {
  return kLastGateMode;
}
constexpr GateFault last_of(GateFault) noexcept {
  return kLastGateFault;
}

namespace detail {

struct AnyValue {
  template <class T>
  operator T() const noexcept;
};

/// Fields of an aggregate, of which `Values` are the first.
template <class Aggregate, class... Values>
consteval std::size_t count_fields() {
  if constexpr (requires { Aggregate{Values{}..., AnyValue{}}; })
    return count_fields<Aggregate, Values..., AnyValue>();
  else
    return sizeof...(Values);
}

}  // namespace detail

static_assert(detail::count_fields<TickSample>() == kTickFieldCount, "kTickFields has every field of TickSample once");

/// Calls visit(field) for every TickField, in order.
template <class Visitor>
constexpr void for_each_tick_field(Visitor&& visit) {
  std::apply([&](const auto&... fields) { (visit(fields), ...); }, kTickFields);
}

/// Calls visit(name, value) for every column of a field; `Sample` is TickSample or const TickSample. A value is a
/// double, std::uint8_t (the tissue), bool, TickEvents or one of the enumerations.
template <class Sample, class Field, class Visitor>
void for_each_column(Sample& sample, const Field& field, Visitor&& visit) {
  auto& value = sample.*field.member;
  if constexpr (kColumnCount<typename Field::Value> == 1) {
    visit(field.columns[0], value);
  } else {
    for (std::size_t i = 0; i < field.columns.size(); ++i) visit(field.columns[i], value[i]);
  }
}

}  // namespace trocar::telemetry
