#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geometry/pose.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {

struct GunShot;

enum class AttemptPhase : std::uint8_t {
  kStarting,    ///< Servers start and load; `progress` is their progress.
  kReady,       ///< Forces are on, the needle is outside the skin.
  kInBody,      ///< The skin was pierced, the needle is inside.
  kServerLost,  ///< No data from the needle: its server or this machine is too slow or has failed; see `banner`.
  kStopped,     ///< Forces were stopped by the trainee; resume_forces() goes on.
  kFinishing,   ///< Being scored.
  kFinished,    ///< result() has the score.
  kFailed,      ///< result() has the error. What was recorded is in the session file.
};
const char* to_string(AttemptPhase phase) noexcept;

/// State of the virtual needle. Frame P.
struct NeedleView {
  bool is_known = false;      ///< A tick has come.
  double time_s = 0.0;        ///< Of the session; 0 until it is recorded.
  Pose X_PN;                  ///< Felt: tip and axis of the virtual needle, the device's roll.
  std::vector<Vec3> shaft_P;  ///< Hub to tip, see needle_shaft.h.
  Pose X_PN_device;           ///< Needle pose of the device: ahead of the virtual needle by the deformation of the
                              ///< tissue.
  Pose X_PN_goal;             ///< Target pose of the hand.
  double resistance_n = 0.0;  ///< Along the needle; positive pushes it out.
  double lag_mm = 0.0;        ///< Distance of the virtual tip behind the hand's, along the axis.
  double depth_mm = 0.0;      ///< Of the tip below the skin.
  double speed_mm_s = 0.0;    ///< Along the axis; positive inward.
  std::string tissue;         ///< At the tip: a label's name where one lies there, else the tissue's; empty outside.
  telemetry::InsertionPhase phase = telemetry::InsertionPhase::kOutside;
  bool is_clamped = false;
};

/// State of the virtual transducer. Frame P.
struct TransducerView {
  bool is_known = false;
  Pose X_PT;                ///< Felt: it does not pass through the skin.
  Pose X_PT_goal;           ///< Where the hand wants it.
  double contact_n = 0.0;   ///< Of skin and face.
  double pressed_mm = 0.0;  ///< Deepest dent of the skin.
  bool is_clamped = false;
};

/// State of a haptic server for the status bar.
struct ServerView {
  std::string tool;  ///< "needle", "probe"
  int pid = 0;
  bool is_connected = false;
  bool is_on = false;                     ///< Its forces are on, and the hand moves it.
  std::string device;                     ///< "virtual:premium"
  double rate_hz = 0.0, wanted_hz = 0.0;  ///< Served, wished for.
  double p99_us = 0.0;                    ///< Lateness of its periods.
  std::uint64_t ticks_missing = 0;        ///< Made there, never received here.
  telemetry::GateMode gate = telemetry::GateMode::kOff;
  telemetry::GateFault fault = telemetry::GateFault::kNone;  ///< Of the safety gate.
  std::string grant;                                         ///< What real time the system granted.
  std::string warning;                                       ///< The server's own.
  bool waits_for_resume = false;  ///< It has no forces until resume_forces(), though nobody stopped them.
  int restarts = 0;               ///< How often it was started again or seated again.
};

/// All data of an attempt displayed by a page at one time.
struct AttemptView {
  AttemptPhase phase = AttemptPhase::kStarting;
  std::string progress;            ///< What is being done in kStarting and kFinishing.
  double progress_fraction = 0.0;  ///< 0..1
  std::string banner;              ///< One line of high importance; empty: no problem.
  std::string recovered;           ///< What the last recovery of a server was, in a sentence.
  int recoveries = 0;              ///< Number of times that forces returned after a server ended or was unavailable.
  std::string message;             ///< What came of the last set_parameters(), or of a command.
  std::string hint;                ///< Instruction for the trainee (guided attempts only); may be empty.
  NeedleView needle;
  TransducerView probe;
  bool has_probe = false;
  std::array<ServerView, 2> servers;  ///< Needle, probe.
  double session_s = 0.0;             ///< Recorded so far, without interruptions.
  double since_contact_s = 0.0;       ///< Since the needle first touched the skin, likewise; 0 before.
  bool are_forces_stopped = false;    ///< By stop_forces(), or a server waits: resume_forces() turns them on again.
  bool has_fired = false;
  std::shared_ptr<const GunShot> shot;  ///< With the first tick after it.
  double since_shot_s = 0.0;            ///< Session time; stops while there are no data from the needle.
  bool is_performing = false;           ///< A scripted operator moves the needle.
  std::vector<std::string> notes;       ///< What went wrong on the way, in order.
};

/// The view with its age taken into account: without an update for 250 ms, the state of a moving needle is unknown.
AttemptView aged(AttemptView view, double age_s);

/// A point of the force plot.
struct ForcePoint {
  double time_s = 0.0;
  double depth_mm = 0.0;
  double force_n = 0.0;  ///< Resistance along the needle; positive pushes it out.
};

/// Something that happened to the needle.
struct AttemptEvent {
  double time_s = 0.0;
  double depth_mm = 0.0;
  telemetry::EventKind kind = telemetry::EventKind::kNone;
  std::string name;  ///< Of the layer or label.
  std::string text;  ///< "through the liver capsule at 1.9 N"
};

}  // namespace trocar::attempt
