// The client's half of codec.h: client messages.
#include <fmt/format.h>

#include <array>

#include "link/codec.h"
#include "link/detail/inspection.h"

namespace trocar::link {
namespace {
using namespace detail;

// docs/link.md publishes these numbers for other implementations of the schema.
template <class Enum>
constexpr bool is_number(Enum value, std::size_t number) {
  return static_cast<std::size_t>(value) == number;
}
static_assert(is_number(wire::Version::Current, kLinkVersion));
static_assert(is_number(wire::SimpleCommandNumber::Start, static_cast<std::size_t>(ServerCommand::kStart)));
static_assert(is_number(wire::SimpleCommandNumber::RestartStatistics, static_cast<std::size_t>(kLastServerCommand)));
static_assert(is_number(wire::MessageBytes::BeforeHello, kMostBytesBeforeHello));
static_assert(is_number(wire::MessageBytes::Most, kMostMessageBytes));
static_assert(is_number(wire::TextBytes::ClientName, kMostNameBytes));
static_assert(is_number(wire::TextBytes::Most, kMostTextBytes));
static_assert(is_number(wire::MostItems::Settings, kMostSettings));
static_assert(is_number(wire::MostItems::Samples, kMostSamples));
static_assert(is_number(wire::MostClients::Controllers, kMostControllers));
static_assert(is_number(wire::MostClients::Watchers, kMostWatchers));
static_assert(is_number(wire::MostClients::ConnectionsBeforeHello, kMostUnauthenticated));
static_assert(is_number(wire::RateLimit::MessagesAtOnce, static_cast<std::size_t>(kMostMessagesAtOnce)));
static_assert(is_number(wire::RateLimit::MessagesPerS, static_cast<std::size_t>(kMostMessagesPerS)));
static_assert(is_number(wire::RateLimit::BytesPerS, static_cast<std::size_t>(kMostBytesPerS)));
static_assert(is_number(wire::Period::ControlLost, static_cast<std::size_t>(1e3 * kControlLost_s)));
static_assert(is_number(wire::Period::HelloPatience, static_cast<std::size_t>(1e3 * kHelloPatience_s)));
static_assert(is_number(wire::EventKind::Limit, static_cast<std::size_t>(telemetry::EventKind::kLimit)));
static_assert(is_number(wire::InsertionPhase::Retracting,
                        static_cast<std::size_t>(telemetry::InsertionPhase::kRetracting)));
static_assert(is_number(wire::GateMode::Absent, static_cast<std::size_t>(telemetry::kLastGateMode)));
static_assert(is_number(wire::GateFault::Vibration, static_cast<std::size_t>(telemetry::kLastGateFault)));
static_assert(is_number(wire::ServerState::Fault, static_cast<std::size_t>(kLastServerState)));
static_assert(is_number(wire::LimitReason::Jumped, static_cast<std::size_t>(telemetry::LimitReason::kJumped)));
static_assert(is_number(wire::LimitReason::Fault, static_cast<std::size_t>(telemetry::LimitReason::kFault)));

// Limits wider than those of the scene (NeedleGeometry, hands), which reports its own errors. [assumed]
constexpr Range kNeedleLengths_mm = {0.0, 1e4};
constexpr Range kNeedleRadii_mm = {0.0, 1e3};
constexpr Range kYoung_gpa = {0.0, 1e4};
constexpr Range kBevels_rad = {0.0, 3.2};
constexpr Range kShares = {0.0, 1.0};
constexpr Range kHandParameters = {0.0, 1e6};
constexpr Range kPressed_mm = {0.0, kMostPressed_mm};
constexpr Range kSettingValues = {-1e9, 1e9};
constexpr Range kCouplings = {-1e6, 1e6};
constexpr Range kBreaths_s = {1.0, 60.0};  // those of motion::check, like the next two
constexpr Range kMotionTimes_s = {-1e9, 1e9};
constexpr Range kDrives = {motion::kLeastDrive, motion::kMostDrive};
constexpr Range kPauses = {0.0, 0.6};
constexpr Range kIrregularities = {0.0, 0.4};
constexpr Range kCoughs_s = {0.0, 3600.0};
constexpr Range kHoldLimits_s = {1.0, 120.0};
constexpr Range kDrifts = {-0.1, 0.1};
constexpr Range kFirstDepths = {0.3, 2.0};
constexpr Range kShifts = {-1.0, 1.0};
constexpr double kMostSpeed_mm_per_s = 1e5;
constexpr double kMostTurning_rad_per_s = 1e4;

// To bytes.

using ClientMember = Member<wire::ClientBody>;
using CommandMember = Member<wire::What>;

wire::MotionDrive packed(const motion::MotionDrive& drive) {
  static_assert(motion::kMostDrivers == 2, "the schema has two depths");
  return {drive.period_s,     drive.begins_s,     flatbuffers::span<const double, motion::kMostDrivers>(drive.depth),
          drive.pause_share,  drive.irregularity, drive.cough_every_s,
          drive.held_phase,   drive.hold_s,       drive.release_s,
          drive.hold_limit_s, drive.drift_per_s,  drive.first_depth,
          drive.drifted,      drive.seed,         drive.is_held};
}

CommandMember build_what(Builder& b, const LoadScene& scene) {
  const Text task = b.CreateString(scene.task), patient = b.CreateString(scene.patient);
  const Text hash = b.CreateString(scene.patient_hash), tool = b.CreateString(scene.tool);
  const Text force_model = b.CreateString(scene.force_model), tissues = b.CreateString(scene.tissues_toml);
  const wire::Needle needle(scene.needle_length_mm, scene.needle_radius_mm, scene.needle_inner_radius_mm,
                            scene.needle_stylet_radius_mm, scene.needle_young_gpa, scene.needle_bevel_rad,
                            scene.needle_bevel_share);
  const wire::Pose X_PW = to_wire(scene.X_PW);
  const Text motion_hash = b.CreateString(scene.motion_hash);
  const wire::MotionDrive motion = packed(scene.motion);
  const auto table = wire::CreateLoadScene(b, task, patient, scene.patient_seed, hash, tool, &needle, force_model,
                                           tissues, scene.seed, &X_PW, motion_hash, &motion);
  return {wire::What::LoadScene, table.Union()};
}

using SettingList = flatbuffers::Offset<flatbuffers::Vector<flatbuffers::Offset<wire::TissueSetting>>>;

SettingList build_settings(Builder& b, const std::vector<TissueSetting>& settings) {
  std::vector<flatbuffers::Offset<wire::TissueSetting>> tables;
  for (const TissueSetting& setting : settings) {
    const Text row = b.CreateString(setting.row), key = b.CreateString(setting.key);
    tables.push_back(wire::CreateTissueSetting(b, row, key, setting.value));
  }
  return b.CreateVector(tables);
}

CommandMember build_what(Builder& b, const SetParameters& parameters) {
  SettingList tissues;
  if (parameters.tissues) tissues = build_settings(b, *parameters.tissues);
  const Text table = b.CreateString(parameters.tissues_toml), force_model = b.CreateString(parameters.force_model);
  std::optional<wire::MotionDrive> motion;
  if (parameters.motion) motion = packed(*parameters.motion);
  return {wire::What::SetParameters,
          wire::CreateSetParameters(b, tissues, table, force_model, parameters.coupling_stiffness_n_per_mm,
                                    parameters.coupling_damping_ns_per_mm, parameters.has_bending,
                                    motion ? &*motion : nullptr)
              .Union()};
}

CommandMember build_what(Builder& b, ServerCommand command) {
  return {wire::What::SimpleCommand,
          wire::CreateSimpleCommand(b, static_cast<wire::SimpleCommandNumber>(command)).Union()};
}

ClientMember build_body(Builder& b, const Hello& hello) {
  const Text client = b.CreateString(hello.client);
  return {wire::ClientBody::Hello, wire::CreateHello(b, client, hello.wants_control).Union()};
}

ClientMember build_body(Builder& b, const Heartbeat& beat) {
  const auto table = wire::CreateHeartbeat(b, beat.client_time_s, beat.window_age_s, beat.ticks_received);
  return {wire::ClientBody::Heartbeat, table.Union()};
}

ClientMember build_body(Builder& b, const Command& command) {
  const auto [type, what] = std::visit([&](const auto& alternative) { return build_what(b, alternative); },  //
                                       command.what);
  return {wire::ClientBody::Command, wire::CreateCommand(b, command.request, type, what).Union()};
}

ClientMember build_body(Builder& b, const HandTarget& target) {
  const wire::Hand hand(to_wire(target.X_PN), to_wire(target.v_P), to_wire(target.w_P), target.server_time_s,
                        target.stiffness_n_per_mm, target.damping_ns_per_mm, target.mass_kg, target.turning_nmm_per_rad,
                        target.turning_damping_nmms_per_rad, target.inertia_kg_mm2, target.pressed_mm, target.buttons,
                        target.holds_tip, target.is_held, target.is_rigid, target.is_placed);
  return {wire::ClientBody::HandTarget, wire::CreateHandTarget(b, &hand).Union()};
}

ClientMember build_body(Builder& b, const Goodbye&) {
  return {wire::ClientBody::Goodbye, wire::CreateGoodbye(b).Union()};
}

// From bytes.

Hello read(const wire::Hello& table, Inspection& in) {
  Hello hello{in.text(table.client(), "client"), table.wants_control()};
  if (hello.client.size() > kMostNameBytes)
    in.refuse(fmt::format("a name of {} bytes, {} are allowed", hello.client.size(), kMostNameBytes), "client");
  return hello;
}

Heartbeat read(const wire::Heartbeat& table, Inspection& in) {
  return {in.number(table.client_time_s(), kTimes_s, "client_time_s"),
          in.number(table.window_age_s(), kDurations_s, "window_age_s"), table.ticks_received()};
}

motion::MotionDrive read(const wire::MotionDrive& from, Inspection& in) {
  motion::MotionDrive drive;
  drive.period_s = in.number(from.period_s(), kBreaths_s, "motion.period_s");
  drive.begins_s = in.number(from.begins_s(), kMotionTimes_s, "motion.begins_s");
  drive.held_phase = in.number(from.held_phase(), kShares, "motion.held_phase");
  for (std::size_t n = 0; n < drive.depth.size(); ++n)
    drive.depth[n] = in.number((*from.depth())[static_cast<flatbuffers::uoffset_t>(n)], kDrives, "motion.depth");
  drive.pause_share = in.number(from.pause_share(), kPauses, "motion.pause_share");
  drive.irregularity = in.number(from.irregularity(), kIrregularities, "motion.irregularity");
  drive.cough_every_s = in.number(from.cough_every_s(), kCoughs_s, "motion.cough_every_s");
  drive.hold_s = in.number(from.hold_s(), kMotionTimes_s, "motion.hold_s");
  drive.release_s = in.number(from.release_s(), kMotionTimes_s, "motion.release_s");
  drive.hold_limit_s = in.number(from.hold_limit_s(), kHoldLimits_s, "motion.hold_limit_s");
  drive.drift_per_s = in.number(from.drift_per_s(), kDrifts, "motion.drift_per_s");
  drive.first_depth = in.number(from.first_depth(), kFirstDepths, "motion.first_depth");
  drive.drifted = in.number(from.drifted(), kShifts, "motion.drifted");
  drive.seed = from.seed();
  drive.is_held = from.is_held();
  if (in.is_valid() && !motion::check(drive)) in.refuse("a number out of its range", "motion");
  return drive;
}

LoadScene read(const wire::LoadScene& table, Inspection& in) {
  LoadScene scene;
  scene.task = in.text(table.task(), "task");
  scene.patient = in.text(table.patient(), "patient");
  scene.patient_seed = table.patient_seed();
  scene.patient_hash = in.text(table.patient_hash(), "patient_hash");
  scene.tool = in.text(table.tool(), "tool");
  const wire::Needle& needle = *table.needle();
  scene.needle_length_mm = in.number(needle.length_mm(), kNeedleLengths_mm, "needle_length_mm");
  scene.needle_radius_mm = in.number(needle.radius_mm(), kNeedleRadii_mm, "needle_radius_mm");
  scene.needle_inner_radius_mm = in.number(needle.inner_radius_mm(), kNeedleRadii_mm, "needle_inner_radius_mm");
  scene.needle_stylet_radius_mm = in.number(needle.stylet_radius_mm(), kNeedleRadii_mm, "needle_stylet_radius_mm");
  scene.needle_young_gpa = in.number(needle.young_gpa(), kYoung_gpa, "needle_young_gpa");
  scene.needle_bevel_rad = in.number(needle.bevel_rad(), kBevels_rad, "needle_bevel_rad");
  scene.needle_bevel_share = in.number(needle.bevel_share(), kShares, "needle_bevel_share");
  scene.force_model = in.text(table.force_model(), "force_model");
  scene.tissues_toml = in.text(table.tissues_toml(), "tissues_toml", Layout::kLines);
  scene.seed = table.seed();
  scene.X_PW = in.pose(*table.x_pw(), "X_PW");
  scene.motion_hash = in.text(table.motion_hash(), "motion_hash");
  scene.motion = read(*table.motion(), in);
  return scene;
}

std::vector<TissueSetting> read(const flatbuffers::Vector<flatbuffers::Offset<wire::TissueSetting>>& list,
                                Inspection& in) {
  std::vector<TissueSetting> settings;
  if (!in.has_room(list.size(), kMostSettings, "tissues")) return settings;
  for (const wire::TissueSetting* setting : list) {
    const std::string row = in.text(setting->row(), "row of a tissue setting");
    const std::string key = in.text(setting->key(), "key of a tissue setting");
    settings.push_back({row, key, in.number(setting->value(), kSettingValues, "value of a tissue setting")});
    if (!in.is_valid()) return {};
  }
  return settings;
}

SetParameters read(const wire::SetParameters& table, Inspection& in) {
  SetParameters parameters;
  if (table.tissues() != nullptr) parameters.tissues = read(*table.tissues(), in);
  parameters.tissues_toml = in.text(table.tissues_toml(), "tissues_toml", Layout::kLines);
  parameters.force_model = in.text(table.force_model(), "force_model");
  parameters.coupling_stiffness_n_per_mm =
      in.number(table.coupling_stiffness_n_per_mm(), kCouplings, "coupling_stiffness_n_per_mm");
  parameters.coupling_damping_ns_per_mm =
      in.number(table.coupling_damping_ns_per_mm(), kCouplings, "coupling_damping_ns_per_mm");
  parameters.has_bending = table.has_bending();
  if (table.motion() != nullptr) parameters.motion = read(*table.motion(), in);
  return parameters;
}

Command read(const wire::Command& table, Inspection& in) {
  Command command{table.request(), {}};
  if (const auto* scene = table.what_as_LoadScene()) {
    command.what = read(*scene, in);
  } else if (const auto* parameters = table.what_as_SetParameters()) {
    command.what = read(*parameters, in);
  } else if (const auto* simple = table.what_as_SimpleCommand()) {
    command.what = in.enumerator(simple->command(), kLastServerCommand, "command");
  } else {
    in.refuse("no command, or an unknown one", "what");
  }
  return command;
}

HandTarget read(const wire::HandTarget& table, Inspection& in) {
  const wire::Hand& hand = *table.hand();
  HandTarget target;
  target.X_PN = in.pose(hand.x_pn(), "X_PN");
  target.v_P = in.vector(hand.v_p(), kMostSpeed_mm_per_s, "v_P");
  target.w_P = in.vector(hand.w_p(), kMostTurning_rad_per_s, "w_P");
  target.server_time_s = in.number(hand.server_time_s(), kTimes_s, "server_time_s");
  target.stiffness_n_per_mm = in.number(hand.stiffness_n_per_mm(), kHandParameters, "stiffness_n_per_mm");
  target.damping_ns_per_mm = in.number(hand.damping_ns_per_mm(), kHandParameters, "damping_ns_per_mm");
  target.mass_kg = in.number(hand.mass_kg(), kHandParameters, "mass_kg");
  target.turning_nmm_per_rad = in.number(hand.turning_nmm_per_rad(), kHandParameters, "turning_nmm_per_rad");
  target.turning_damping_nmms_per_rad =
      in.number(hand.turning_damping_nmms_per_rad(), kHandParameters, "turning_damping_nmms_per_rad");
  target.inertia_kg_mm2 = in.number(hand.inertia_kg_mm2(), kHandParameters, "inertia_kg_mm2");
  target.pressed_mm = in.number(hand.pressed_mm(), kPressed_mm, "pressed_mm");
  target.holds_tip = hand.holds_tip();
  target.buttons = hand.buttons();
  target.is_held = hand.is_held();
  target.is_rigid = hand.is_rigid();
  target.is_placed = hand.is_placed();
  return target;
}

ClientBody read(const wire::ClientMessage& table, Inspection& in) {
  if (const auto* hello = table.body_as_Hello()) return read(*hello, in);
  if (const auto* beat = table.body_as_Heartbeat()) return read(*beat, in);
  if (const auto* command = table.body_as_Command()) return read(*command, in);
  if (const auto* target = table.body_as_HandTarget()) return read(*target, in);
  if (table.body_as_Goodbye() == nullptr) in.refuse("no body, or an unknown one", "body");
  return Goodbye{};
}

}  // namespace

Bytes encode(const ClientMessage& message) {
  Builder b;
  b.ForceDefaults(true);  // otherwise zeros are omitted, and -0.0 counts as zero
  const auto [type, body] = std::visit([&](const auto& alternative) { return build_body(b, alternative); },  //
                                       message.body);
  b.Finish(wire::CreateClientMessage(b, kLinkVersion, message.session, message.sequence, type, body),
           kClientIdentifier);
  return take_bytes(b);
}

Result<ClientMessage> decode_client_message(std::span<const std::byte> bytes) {
  TROCAR_TRY_STATUS(check_size(bytes.size()));
  const AlignedBytes aligned(bytes);
  TROCAR_TRY(const wire::ClientMessage* root, find_root<wire::ClientMessage>(aligned, kClientIdentifier));
  Inspection inspection(bytes.size());
  ClientMessage message{root->session(), root->sequence(), read(*root, inspection)};
  if (!inspection.is_valid()) return tl::unexpected(*inspection.complaint());
  return message;
}

std::optional<CommandNumber> find_command(std::span<const std::byte> bytes) {
  if (!check_size(bytes.size())) return {};
  const AlignedBytes aligned(bytes);
  const auto root = find_root<wire::ClientMessage>(aligned, kClientIdentifier);
  if (!root || (*root)->body_as_Command() == nullptr) return {};
  return CommandNumber{(*root)->session(), (*root)->sequence(), (*root)->body_as_Command()->request()};
}

}  // namespace trocar::link
