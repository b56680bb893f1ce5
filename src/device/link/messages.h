#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "geometry/pose.h"
#include "motion/patient_motion.h"
#include "realtime/loop_statistics.h"
#include "telemetry/needle_shape.h"
#include "telemetry/tick_sample.h"

namespace trocar::link {

/// State of a haptic server.
enum class ServerState : std::uint8_t {
  kNoScene,  ///< No scene was loaded yet.
  kLoading,  ///< Builds a scene.
  kReady,    ///< Has a scene; forces are not requested.
  kRunning,  ///< Forces are requested; GateMode states whether they are on.
  kFault,    ///< The safety gate has latched a fault.
};
inline constexpr ServerState kLastServerState = ServerState::kFault;
/// Text for messages: "no scene", "loading", "ready", "running", "fault".
const char* to_string(ServerState state) noexcept;

}  // namespace trocar::link

/// Limits of a server for its clients. docs/link.md lists these numbers for other implementations.
namespace trocar::link {

inline constexpr std::size_t kMostMessageBytes = 1 << 20;  ///< Larger messages are dropped unread.
inline constexpr std::size_t kMostTextBytes = 256 * 1024;  ///< Limit of one string (a tissue table is the longest).
inline constexpr std::size_t kMostNameBytes = 256;         ///< Limit of a client's name in Hello.
inline constexpr std::size_t kMostBytesBeforeHello = 4096;
inline constexpr double kMostPressed_mm = 100.0;  ///< Of a placed needle: see HandTarget.

// Rate limits of one connection, before and after Hello. A peer above them is read more slowly. [assumed]
inline constexpr double kMostMessagesPerS = 4000.0;  ///< Above 1 kHz of hand targets plus heartbeats and commands.
inline constexpr double kMostMessagesAtOnce = 1000.0;
inline constexpr double kMostBytesPerS = 4.0 * 1024 * 1024;
inline constexpr double kMostBytesAtOnce = 4.0 * 1024 * 1024;
/// Limit of bytes queued for a client; further batches are dropped for it [assumed: two seconds at 1 kHz].
inline constexpr std::size_t kMostBytesOut = 1280 * 1024;
/// Additional queue for replies to commands, which are never dropped; a client with a full reply queue is removed.
inline constexpr std::size_t kMostReplyBytesOut = 1 << 20;

// Connections and clients. [assumed]
inline constexpr std::size_t kMostUnauthenticated = 16;  ///< Connections that have not sent Hello.
inline constexpr std::size_t kMostControllers = 4;       ///< Clients that request control; one of them has it.
inline constexpr std::size_t kMostWatchers = 8;          ///< Clients that do not request control.
inline constexpr double kMostAcceptedPerS = 100.0;
inline constexpr double kMostAcceptedAtOnce = 16.0;
inline constexpr double kMostRefusalsPerS = 10.0;  ///< Refusals of invalid messages, for one connection.
inline constexpr double kMostRefusalsAtOnce = 10.0;
inline constexpr double kHelloPatience_s = 5.0;  ///< A connection without a valid Hello is closed after this time.

inline constexpr std::uint32_t kLinkVersion = 7;  ///< Both sides must have the same version.

// From a client.

/// The first message. The first client that requests control gets it until it disconnects or times out
/// (kControlLost_s); other clients can watch.
struct Hello {
  std::string client;
  bool wants_control = true;
};

/// Sent at 100 Hz by a separate thread of the client.
struct Heartbeat {
  double client_time_s = 0.0;        ///< Steady clock of the client; the Pong returns it.
  double window_age_s = 0.0;         ///< Time since the client's window last drew a frame; 0: no window.
  std::uint64_t ticks_received = 0;  ///< Ticks received so far.
};

/// A scene: patient, tool, tissues, force model. The server builds it outside of the real-time thread and swaps it in
/// as a whole.
struct LoadScene {
  std::string task;     ///< Only for status and log.
  std::string patient;  ///< Folder (on the server's machine), or name of an embedded patient.
  std::uint64_t patient_seed = 1;
  std::string patient_hash;         ///< A patient with another hash is refused; empty: any hash.
  std::string motion_hash;          ///< A patient with another motion model is refused; empty: any, or none.
  motion::MotionDrive motion;       ///< begins_s in the server's clock.
  std::string tool = "needle";      ///< needle | probe | finger
  double needle_length_mm = 150.0;  ///< Grip to tip. The needle_ fields are those of NeedleGeometry.
  double needle_radius_mm = 0.635;
  double needle_inner_radius_mm = 0.0;
  double needle_stylet_radius_mm = 0.0;  ///< 0: no stylet.
  double needle_young_gpa = 200.0;
  double needle_bevel_rad = 0.3490658503988659;
  double needle_bevel_share = 0.1;
  std::string force_model = "insertion";
  std::string tissues_toml;  ///< The whole table; empty: the server's table.
  std::uint64_t seed = 1;
  Pose X_PW;  ///< Room in the patient.
};

/// A value of the tissue table; anatomy/tissue/tissue_settings.h has rows, keys and ranges.
struct TissueSetting {
  std::string row, key;         ///< "liver", "k"
  std::optional<double> value;  ///< Empty: the tissue never yields.
  bool operator==(const TissueSetting&) const = default;
};

/// Changes a running scene. The server builds the scene again and swaps it in; the insertion continues unless the force
/// model changes. Empty fields leave the values unchanged.
struct SetParameters {
  /// All values that differ from the loaded table. They replace those of the last message that had a list. An empty
  /// list restores the loaded table.
  std::optional<std::vector<TissueSetting>> tissues = {};
  std::string tissues_toml = {};  ///< Replaces the loaded table; `tissues` then applies to this table.
  std::string force_model = {};   ///< insertion | proxy | combined
  std::optional<double> coupling_stiffness_n_per_mm = {};
  std::optional<double> coupling_damping_ns_per_mm = {};
  std::optional<bool> has_bending = {};
  std::optional<motion::MotionDrive> motion = {};  ///< begins_s in the server's clock.
  bool operator==(const SetParameters&) const = default;
};

enum class ServerCommand : std::uint8_t {
  kStart,  ///< Forces on (through the safe start).
  kStop,   ///< Forces off. Never refused: every client may send it.
  kResetFault,
  kReconnect,  ///< Reopen the device.
  kStyletOut,
  kStyletIn,
  kRestartStatistics,  ///< Statistics of the loop.
};
inline constexpr ServerCommand kLastServerCommand = ServerCommand::kRestartStatistics;

/// The server answers a command with a Reply that has the same number.
struct Command {
  std::uint32_t request = 0;
  std::variant<LoadScene, SetParameters, ServerCommand> what = ServerCommand::kStop;
};
/// The only command that a client without control may send.
inline bool is_stop(const Command& command) noexcept {
  const auto* simple = std::get_if<ServerCommand>(&command.what);
  return simple != nullptr && *simple == ServerCommand::kStop;
}

/// Target pose of the tool for a simulated hand or a pointer: X_PN of a needle, X_PT of a transducer. No reply; the
/// server uses only the newest target.
struct HandTarget {
  Pose X_PN;
  Vec3 v_P = Vec3::Zero();     ///< mm/s, of the tip (for extrapolation).
  Vec3 w_P = Vec3::Zero();     ///< rad/s, for extrapolation.
  double server_time_s = 0.0;  ///< Time of the target, server's clock.
  double stiffness_n_per_mm = 0.6;
  double damping_ns_per_mm = 0.012;
  double mass_kg = 0.15;
  double turning_nmm_per_rad = 300.0;
  double turning_damping_nmms_per_rad = 8.0;
  double inertia_kg_mm2 = 50.0;
  bool holds_tip = false;  ///< The spring acts at the tip; false: at the grip.
  std::uint32_t buttons = 0;
  bool is_held = true;
  bool is_rigid = false;
  bool is_placed = false;  ///< Placed at X_PN now, at rest; the insertion restarts there, through the safe start.
  /// Of a placed needle: how far the tissue that it had pressed in gives way again (physics.md S1).
  /// 0..kMostPressed_mm.
  double pressed_mm = 0.0;
};

struct Goodbye {};

using ClientBody = std::variant<Hello, Heartbeat, Command, HandTarget, Goodbye>;

// From the server.

/// Data of the device, for display by a client.
struct DeviceSummary {
  std::string name, title;
  int sensed_dof = 6, actuated_dof = 6;
  double workspace_radius_mm = 0.0;
  double peak_force_n = 0.0, continuous_force_n = 0.0, peak_torque_nmm = 0.0;
  double force_scale = 1.0;
};

/// Answer to Hello. Every later message of this client carries `session`.
struct Welcome {
  std::uint64_t session = 0;
  std::string server;  ///< "trocar-hapticd 0.1.0"
  std::string tool;
  bool has_control = false;
  DeviceSummary device;
};

struct Reply {
  std::uint32_t request = 0;
  bool is_done = false;
  std::string text;  ///< The error text, or a description of what was done.
  /// For a command that made a scene (LoadScene, SetParameters): number of the scene. The fields below are its
  /// parameters. A scene takes effect at the first tick whose batch has its number; that batch may arrive before this
  /// reply.
  std::uint64_t scene = 0;                ///< 0: no new scene. Increases while the server runs.
  std::vector<std::string> options = {};  ///< "coupling.stiffness=0.8", see haptics/option_texts.h.
  std::string tissues_toml = {};          ///< The whole table.
};

struct Pong {
  double client_time_s = 0.0;  ///< client_time_s of the heartbeat.
  double server_time_s = 0.0;
};

/// Data for a status bar.
struct ServerStatus {
  double server_time_s = 0.0;
  ServerState state = ServerState::kNoScene;
  telemetry::GateMode gate_mode = telemetry::GateMode::kOff;
  telemetry::GateFault fault = telemetry::GateFault::kNone;
  std::string warning;  ///< "the client's window has stood still for 2 s"; empty: none.
  std::string grant;    ///< RealTimeGrant::text
  std::string patient, patient_hash, force_model, task;
  double loading = 0.0;  ///< 0..1 while a scene is being built.
  realtime::LoopSummary loop;
  std::uint64_t ticks = 0;          ///< Ticks made.
  std::uint64_t ticks_dropped = 0;  ///< Ticks that are in no batch; includes every gap in the tick numbers.
  std::uint64_t messages_refused = 0;
  std::uint32_t gate_actions = 0;     ///< GateAction bits since the last status.
  double drop_n = 0.0, drop_s = 0.0;  ///< Size and duration of the last drop of the force.
  bool is_device_connected = true;
  bool has_controller = false;
  double coupling_share = 1.0;  ///< Smallest value since the last status, 0..1; below 1: the loop is slow.
};

/// Consecutive ticks of one scene: number of the first tick, and at most kMostSamples ticks. The status comes with the
/// newest tick.
struct StateBatch {
  std::uint64_t first_tick = 0;
  std::vector<telemetry::TickSample> samples;
  std::optional<ServerStatus> status;  ///< Not in every batch: at most 20 times per second.
  std::uint64_t scene = 0;             ///< See Reply::scene; 0: none.
  /// Shape of the needle at the tick of its time; not in every batch.
  std::optional<telemetry::NeedleShape> shape = {};
};
inline constexpr std::size_t kMostSamples = 512;

/// Reason for refusing a message. For a client without a session, session and sequence are 0.
struct Refusal {
  std::string text;  ///< Like Error::text.
};

using ServerBody = std::variant<Welcome, StateBatch, Reply, Pong, Refusal>;

/// A message on the wire: a body with session and sequence number.
template <class Body>
struct Envelope {
  std::uint64_t session = 0;   ///< Session of the Welcome; 0 in a Hello.
  std::uint64_t sequence = 0;  ///< Increases by one with every message of a session.
  Body body;
};
using ClientMessage = Envelope<ClientBody>;
using ServerMessage = Envelope<ServerBody>;

inline constexpr double kControlLost_s = 2.0;

}  // namespace trocar::link
