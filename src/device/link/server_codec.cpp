// The server's half of codec.h: server messages.
#include "core/result.h"
#include "link/codec.h"
#include "link/detail/inspection.h"
#include "link/detail/wire_sample.h"

namespace trocar::link {
namespace {
using namespace detail;

constexpr int kMostDof = 7;                        ///< Six numbers and a grip.
constexpr std::size_t kBytesBeforeSamples = 2048;  ///< Frame and status of a batch: initial size of a builder.

// To bytes.

using ServerMember = Member<wire::ServerBody>;

ServerMember build_body(Builder& b, const Welcome& welcome) {
  const DeviceSummary& device = welcome.device;
  const Text name = b.CreateString(device.name), title = b.CreateString(device.title);
  const auto summary = wire::CreateDeviceSummary(b, name, title, device.sensed_dof, device.actuated_dof,
                                                 device.workspace_radius_mm, device.peak_force_n,
                                                 device.continuous_force_n, device.peak_torque_nmm, device.force_scale);
  const Text server = b.CreateString(welcome.server), tool = b.CreateString(welcome.tool);
  const auto table = wire::CreateWelcome(b, welcome.session, server, tool, welcome.has_control, summary);
  return {wire::ServerBody::Welcome, table.Union()};
}

wire::Latency to_wire(const realtime::LatencySummary& latency) {
  return {latency.p50_us, latency.p99_us, latency.p999_us, latency.max_us};
}

flatbuffers::Offset<wire::ServerStatus> build_status(Builder& b, const ServerStatus& status) {
  const auto state = static_cast<wire::ServerState>(status.state);
  const auto gate_mode = static_cast<wire::GateMode>(status.gate_mode);
  const auto fault = static_cast<wire::GateFault>(status.fault);
  const Text warning = b.CreateString(status.warning), grant = b.CreateString(status.grant);
  const Text patient = b.CreateString(status.patient);
  const Text hash = b.CreateString(status.patient_hash), force_model = b.CreateString(status.force_model);
  const Text task = b.CreateString(status.task);
  const realtime::LoopSummary& l = status.loop;
  const wire::Loop loop(l.wanted_hz, l.achieved_hz, l.periods, l.missed, l.skipped, to_wire(l.lateness),
                        to_wire(l.tick));
  return wire::CreateServerStatus(b, status.server_time_s, state, gate_mode, fault, warning, grant, patient, hash,
                                  force_model, task, status.loading, &loop, status.ticks, status.ticks_dropped,
                                  status.messages_refused, status.gate_actions, status.drop_n, status.drop_s,
                                  status.is_device_connected, status.has_controller, status.coupling_share);
}

flatbuffers::Offset<wire::NeedleShape> build_shape(Builder& b, const telemetry::NeedleShape& shape) {
  TROCAR_CHECK(shape.spans <= telemetry::NeedleShape::kMostSpans);
  const auto points = b.CreateVectorOfStructs<wire::Beside>(shape.spans, [&](std::size_t i, wire::Beside* packed) {
    *packed = {shape.beside_mm[i][0], shape.beside_mm[i][1]};
  });
  return wire::CreateNeedleShape(b, shape.time_s, points);
}

ServerMember build_body(Builder& b, const StateBatch& batch) {
  TROCAR_CHECK(batch.samples.size() <= kMostSamples);
  const auto samples = b.CreateVectorOfStructs<wire::Sample>(
      batch.samples.size(), [&](std::size_t i, wire::Sample* packed) { write_sample(batch.samples[i], *packed); });
  flatbuffers::Offset<wire::ServerStatus> status;
  if (batch.status) status = build_status(b, *batch.status);
  flatbuffers::Offset<wire::NeedleShape> shape;
  if (batch.shape) shape = build_shape(b, *batch.shape);
  return {wire::ServerBody::StateBatch,
          wire::CreateStateBatch(b, batch.first_tick, samples, status, batch.scene, shape).Union()};
}

ServerMember build_body(Builder& b, const Reply& reply) {
  const Text text = b.CreateString(reply.text), tissues = b.CreateString(reply.tissues_toml);
  const auto options = b.CreateVectorOfStrings(reply.options);
  const auto table = wire::CreateReply(b, reply.request, reply.is_done, text, reply.scene, options, tissues);
  return {wire::ServerBody::Reply, table.Union()};
}

ServerMember build_body(Builder& b, const Pong& pong) {
  return {wire::ServerBody::Pong, wire::CreatePong(b, pong.client_time_s, pong.server_time_s).Union()};
}

ServerMember build_body(Builder& b, const Refusal& refusal) {
  const Text text = b.CreateString(refusal.text);
  return {wire::ServerBody::Refusal, wire::CreateRefusal(b, text).Union()};
}

/// Size of the builder, so that it allocates once.
std::size_t expected_bytes(const ServerMessage& message) {
  const auto* batch = std::get_if<StateBatch>(&message.body);
  return kBytesBeforeSamples + (batch == nullptr ? 0 : batch->samples.size() * sizeof(wire::Sample));
}

// From bytes.

Welcome read(const wire::Welcome& table, Inspection& in) {
  const wire::DeviceSummary& summary = *table.device();
  DeviceSummary device;
  device.name = in.text(summary.name(), "device name");
  device.title = in.text(summary.title(), "device title");
  device.sensed_dof = in.whole_number(summary.sensed_dof(), 0, kMostDof, "sensed_dof");
  device.actuated_dof = in.whole_number(summary.actuated_dof(), 0, kMostDof, "actuated_dof");
  device.workspace_radius_mm = in.number(summary.workspace_radius_mm(), kMagnitudes, "workspace_radius_mm");
  device.peak_force_n = in.number(summary.peak_force_n(), kMagnitudes, "peak_force_n");
  device.continuous_force_n = in.number(summary.continuous_force_n(), kMagnitudes, "continuous_force_n");
  device.peak_torque_nmm = in.number(summary.peak_torque_nmm(), kMagnitudes, "peak_torque_nmm");
  device.force_scale = in.number(summary.force_scale(), kMagnitudes, "force_scale");
  return {table.session(), in.text(table.server(), "server"), in.text(table.tool(), "tool"), table.has_control(),
          std::move(device)};
}

realtime::LatencySummary read(const wire::Latency& latency, Inspection& in) {
  const char* const field = "latency of the loop";
  return {in.number(latency.p50_us(), kMagnitudes, field), in.number(latency.p99_us(), kMagnitudes, field),
          in.number(latency.p999_us(), kMagnitudes, field), in.number(latency.max_us(), kMagnitudes, field)};
}

realtime::LoopSummary read(const wire::Loop& loop, Inspection& in) {
  return {in.number(loop.wanted_hz(), kMagnitudes, "wanted_hz"),
          in.number(loop.achieved_hz(), kMagnitudes, "achieved_hz"),
          loop.periods(),
          loop.missed(),
          loop.skipped(),
          read(loop.lateness(), in),
          read(loop.tick(), in)};
}

ServerStatus read(const wire::ServerStatus& table, Inspection& in) {
  ServerStatus status;
  status.server_time_s = in.number(table.server_time_s(), kTimes_s, "server_time_s");
  status.state = in.enumerator(table.state(), kLastServerState, "state");
  status.gate_mode = in.enumerator(table.gate_mode(), telemetry::kLastGateMode, "gate_mode");
  status.fault = in.enumerator(table.fault(), telemetry::kLastGateFault, "fault");
  status.warning = in.text(table.warning(), "warning");
  status.grant = in.text(table.grant(), "grant");
  status.patient = in.text(table.patient(), "patient");
  status.patient_hash = in.text(table.patient_hash(), "patient_hash");
  status.force_model = in.text(table.force_model(), "force_model");
  status.task = in.text(table.task(), "task");
  status.loading = in.number(table.loading(), {0.0, 1.0}, "loading");
  status.loop = read(*table.loop(), in);
  status.ticks = table.ticks();
  status.ticks_dropped = table.ticks_dropped();
  status.messages_refused = table.messages_refused();
  status.gate_actions = table.gate_actions();
  status.drop_n = in.number(table.drop_n(), kMagnitudes, "drop_n");
  status.drop_s = in.number(table.drop_s(), kDurations_s, "drop_s");
  status.is_device_connected = table.is_device_connected();
  status.has_controller = table.has_controller();
  status.coupling_share = in.number(table.coupling_share(), {0.0, 1.0}, "coupling_share");
  return status;
}

void read_samples(const flatbuffers::Vector<const wire::Sample*>& samples, Inspection& in,
                  std::vector<telemetry::TickSample>& result) {
  if (samples.size() == 0) return;  // FlatBuffers aligns only non-empty vectors
  if (samples.size() > kMostSamples) return in.refuse("more ticks than a batch may have", "samples");
  // FlatBuffers verifies that a vector of structs is within the message, but not its alignment.
  if (reinterpret_cast<std::uintptr_t>(samples.Data()) % alignof(wire::Sample) != 0) {
    return in.refuse("misaligned ticks", "samples");
  }
  result.reserve(samples.size());
  for (const wire::Sample* packed : samples) {
    read_sample(*packed, in, result.emplace_back());
    if (!in.is_valid()) return;
  }
}

telemetry::NeedleShape read(const wire::NeedleShape& table, Inspection& in) {
  telemetry::NeedleShape shape;
  shape.time_s = in.number(table.time_s(), kTimes_s, "time_s");
  if (table.beside_mm() == nullptr || table.beside_mm()->size() == 0) return shape;
  const auto& points = *table.beside_mm();
  constexpr std::size_t kMost = telemetry::NeedleShape::kMostSpans;
  const bool is_aligned = reinterpret_cast<std::uintptr_t>(points.Data()) % alignof(wire::Beside) == 0;
  if (points.size() > kMost || !is_aligned) {
    in.refuse(is_aligned ? "more points than a shaft may have" : "misaligned points", "beside_mm");
    return shape;
  }
  constexpr Range kBeside_mm = {-telemetry::kMostBeside_mm, telemetry::kMostBeside_mm};
  for (const wire::Beside* point : points) {
    const double x = in.number(point->x_mm(), kBeside_mm, "beside_mm"),
                 y = in.number(point->y_mm(), kBeside_mm, "beside_mm");
    shape.beside_mm[shape.spans++] = {static_cast<float>(x), static_cast<float>(y)};
  }
  return shape;
}

StateBatch read(const wire::StateBatch& table, Inspection& in) {
  StateBatch batch;
  batch.first_tick = table.first_tick();
  batch.scene = table.scene();
  if (table.samples() != nullptr) read_samples(*table.samples(), in, batch.samples);
  if (table.status() != nullptr) batch.status = read(*table.status(), in);
  if (table.shape() != nullptr) batch.shape = read(*table.shape(), in);
  return batch;
}

Reply read(const wire::Reply& table, Inspection& in) {
  Reply reply{table.request(), table.is_done(), in.text(table.text(), "text"), table.scene()};
  reply.options = in.texts(table.options(), "options");
  reply.tissues_toml = in.text(table.tissues_toml(), "tissues_toml", Layout::kLines);
  return reply;
}

Pong read(const wire::Pong& table, Inspection& in) {
  return {in.number(table.client_time_s(), kTimes_s, "client_time_s"),
          in.number(table.server_time_s(), kTimes_s, "server_time_s")};
}

Refusal read(const wire::Refusal& table, Inspection& in) {
  return {in.text(table.text(), "text")};
}

ServerBody read(const wire::ServerMessage& table, Inspection& in) {
  if (const auto* welcome = table.body_as_Welcome()) return read(*welcome, in);
  if (const auto* batch = table.body_as_StateBatch()) return read(*batch, in);
  if (const auto* reply = table.body_as_Reply()) return read(*reply, in);
  if (const auto* pong = table.body_as_Pong()) return read(*pong, in);
  if (const auto* refusal = table.body_as_Refusal()) return read(*refusal, in);
  in.refuse("no body, or an unknown one", "body");
  return Pong{};
}

}  // namespace

Bytes encode(const ServerMessage& message) {
  Builder b(expected_bytes(message));
  b.ForceDefaults(true);  // otherwise zeros are omitted, and -0.0 counts as zero
  const auto [type, body] = std::visit([&](const auto& alternative) { return build_body(b, alternative); },  //
                                       message.body);
  b.Finish(wire::CreateServerMessage(b, kLinkVersion, message.session, message.sequence, type, body),
           kServerIdentifier);
  return take_bytes(b);
}

Result<ServerMessage> decode_server_message(std::span<const std::byte> bytes) {
  TROCAR_TRY_STATUS(check_size(bytes.size()));
  const AlignedBytes aligned(bytes);
  TROCAR_TRY(const wire::ServerMessage* root, find_root<wire::ServerMessage>(aligned, kServerIdentifier));
  Inspection inspection(bytes.size());
  ServerMessage message{root->session(), root->sequence(), read(*root, inspection)};
  if (!inspection.is_valid()) return tl::unexpected(*inspection.complaint());
  return message;
}

}  // namespace trocar::link
