#include "link/detail/wire_sample.h"

namespace trocar::link::detail {
namespace {

constexpr double kLongestAxis = 2.0;  ///< A unit vector, with tolerance for rounding and for a tick without one (zero).
constexpr flatbuffers::uoffset_t kEvents = 4;
static_assert(std::tuple_size_v<decltype(telemetry::TickSample::events)> == kEvents);

}  // namespace

wire::Sample to_wire(const telemetry::TickSample& s) {
  std::array<wire::Event, kEvents> events;
  for (std::size_t i = 0; i < kEvents; ++i) {
    events[i] = {static_cast<std::uint8_t>(s.events[i].kind), s.events[i].id};
  }
  return {s.time_s,
          to_wire(s.tip_mm),
          to_wire(s.axis),
          s.axial_velocity_mm_s,
          s.depth_mm,
          s.layer_displacement_mm,
          s.f_prepuncture_n,
          s.f_friction_n,
          s.f_cutting_n,
          to_wire(s.f_constraint_n),
          to_wire(s.f_weight_n),
          to_wire(s.f_total_n),
          to_wire(s.tau_nmm),
          s.breathing,
          to_wire(s.f_tip_proxy_n),
          s.f_body_axial_n,
          s.f_stick_n,
          to_wire(s.device_mm),
          to_wire(s.device_f_n),
          flatbuffers::span<const double, 4>(s.device_rotation_wxyz.data(), 4),
          to_wire(s.contact_to_puncture_mm),
          to_wire(s.device_tau_nmm),
          s.gate_scale,
          s.coupling_share,
          flatbuffers::span<const wire::Event, kEvents>(events.data(), kEvents),
          s.tissue,
          static_cast<std::uint8_t>(s.phase),
          s.limited,
          static_cast<std::uint8_t>(s.gate_mode),
          static_cast<std::uint8_t>(s.gate_fault)};
}

telemetry::TickSample read_sample(const wire::Sample& w, Inspection& inspection) {
  telemetry::TickSample s;
  s.time_s = inspection.number(w.time_s(), kTimes_s, "time_s of a tick");
  s.tip_mm = inspection.vector(w.tip_mm(), kMostPosition_mm, "tip_mm of a tick");
  s.axis = inspection.vector(w.axis(), kLongestAxis, "axis of a tick");
  s.axial_velocity_mm_s = w.axial_velocity_mm_s();
  s.depth_mm = w.depth_mm();
  s.tissue = w.tissue();
  s.phase = inspection.enumerator(w.phase(), telemetry::InsertionPhase::kRetracting, "phase of a tick");
  s.layer_displacement_mm = w.layer_displacement_mm();
  s.f_prepuncture_n = w.f_prepuncture_n();
  s.f_friction_n = w.f_friction_n();
  s.f_cutting_n = w.f_cutting_n();
  s.f_constraint_n = from_wire(w.f_constraint_n());
  s.f_weight_n = from_wire(w.f_weight_n());
  s.f_total_n = from_wire(w.f_total_n());
  s.tau_nmm = from_wire(w.tau_nmm());
  for (flatbuffers::uoffset_t i = 0; i < kEvents; ++i) {
    const wire::Event& event = *w.events()->Get(i);
    s.events[i] = {inspection.enumerator(event.kind(), telemetry::EventKind::kLimit, "event of a tick"), event.id()};
  }
  s.limited = w.limited();
  s.breathing = w.breathing();
  s.f_tip_proxy_n = from_wire(w.f_tip_proxy_n());
  s.f_body_axial_n = w.f_body_axial_n();
  s.f_stick_n = w.f_stick_n();
  s.device_mm = inspection.vector(w.device_mm(), kMostPosition_mm, "device_mm of a tick");
  s.device_f_n = from_wire(w.device_f_n());
  for (flatbuffers::uoffset_t i = 0; i < 4; ++i) s.device_rotation_wxyz[i] = w.device_rotation_wxyz()->Get(i);
  s.contact_to_puncture_mm = from_wire(w.contact_to_puncture_mm());
  s.device_tau_nmm = from_wire(w.device_tau_nmm());
  s.gate_scale = w.gate_scale();
  s.coupling_share = w.coupling_share();
  s.gate_mode = inspection.enumerator(w.gate_mode(), telemetry::kLastGateMode, "gate_mode of a tick");
  s.gate_fault = inspection.enumerator(w.gate_fault(), telemetry::kLastGateFault, "gate_fault of a tick");
  return s;
}

}  // namespace trocar::link::detail
