#pragma once

#include <type_traits>

#include "telemetry/tick_sample.h"

namespace trocar::storage::detail {

/// The one ordered list of what a session keeps of a tick: calls visit(name, field) for every column of
/// `trocar session export --csv`, in its order. Fields are double, std::uint8_t (the tissue), InsertionPhase, bool
/// (limited), GateMode, GateFault or the array of events. `Sample` is TickSample or const TickSample.
template <class Sample, class Visitor>
void visit_columns(Sample& s, Visitor&& visit) {
  static_assert(std::is_same_v<std::remove_const_t<Sample>, telemetry::TickSample>);
  visit("time_s", s.time_s);
  visit("tip_x_mm", s.tip_mm[0]);
  visit("tip_y_mm", s.tip_mm[1]);
  visit("tip_z_mm", s.tip_mm[2]);
  visit("axis_x", s.axis[0]);
  visit("axis_y", s.axis[1]);
  visit("axis_z", s.axis[2]);
  visit("axial_velocity_mm_s", s.axial_velocity_mm_s);
  visit("depth_mm", s.depth_mm);
  visit("tissue", s.tissue);
  visit("phase", s.phase);
  visit("layer_displacement_mm", s.layer_displacement_mm);
  visit("f_prepuncture_n", s.f_prepuncture_n);
  visit("f_friction_n", s.f_friction_n);
  visit("f_cutting_n", s.f_cutting_n);
  visit("f_constraint_x_n", s.f_constraint_n[0]);
  visit("f_constraint_y_n", s.f_constraint_n[1]);
  visit("f_constraint_z_n", s.f_constraint_n[2]);
  visit("f_weight_x_n", s.f_weight_n[0]);
  visit("f_weight_y_n", s.f_weight_n[1]);
  visit("f_weight_z_n", s.f_weight_n[2]);
  visit("f_total_x_n", s.f_total_n[0]);
  visit("f_total_y_n", s.f_total_n[1]);
  visit("f_total_z_n", s.f_total_n[2]);
  visit("tau_x_nmm", s.tau_nmm[0]);
  visit("tau_y_nmm", s.tau_nmm[1]);
  visit("tau_z_nmm", s.tau_nmm[2]);
  visit("event", s.events);
  visit("limited", s.limited);
  visit("breathing", s.breathing);
  visit("f_tip_proxy_x_n", s.f_tip_proxy_n[0]);
  visit("f_tip_proxy_y_n", s.f_tip_proxy_n[1]);
  visit("f_tip_proxy_z_n", s.f_tip_proxy_n[2]);
  visit("f_body_axial_n", s.f_body_axial_n);
  visit("f_stick_n", s.f_stick_n);
  visit("device_x_mm", s.device_mm[0]);
  visit("device_y_mm", s.device_mm[1]);
  visit("device_z_mm", s.device_mm[2]);
  visit("device_f_x_n", s.device_f_n[0]);
  visit("device_f_y_n", s.device_f_n[1]);
  visit("device_f_z_n", s.device_f_n[2]);
  visit("device_tau_x_nmm", s.device_tau_nmm[0]);
  visit("device_tau_y_nmm", s.device_tau_nmm[1]);
  visit("device_tau_z_nmm", s.device_tau_nmm[2]);
  visit("gate_mode", s.gate_mode);
  visit("gate_fault", s.gate_fault);
  visit("gate_scale", s.gate_scale);
  visit("coupling_share", s.coupling_share);
}

/// The columns of the `ticks` table: those above but the events, which have a table of their own, and the rotation of
/// the device, which a replay needs.
template <class Sample, class Visitor>
void visit_stored_columns(Sample& s, Visitor&& visit) {
  visit_columns(s, [&](const char* name, auto& field) {
    if constexpr (!std::is_same_v<std::remove_const_t<std::remove_reference_t<decltype(field)>>,
                                  std::array<telemetry::TickEvent, 4>>)
      visit(name, field);
  });
  visit("device_qw", s.device_rotation_wxyz[0]);
  visit("device_qx", s.device_rotation_wxyz[1]);
  visit("device_qy", s.device_rotation_wxyz[2]);
  visit("device_qz", s.device_rotation_wxyz[3]);
  visit("px_p_x_mm", s.contact_to_puncture_mm.x());
  visit("px_p_y_mm", s.contact_to_puncture_mm.y());
  visit("px_p_z_mm", s.contact_to_puncture_mm.z());
}

/// Whether a visited field is kept as a real number (else as an integer).
template <class Field>
inline constexpr bool kIsReal = std::is_same_v<std::remove_const_t<Field>, double>;

}  // namespace trocar::storage::detail
