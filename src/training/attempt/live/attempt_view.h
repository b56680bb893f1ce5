#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/clock.h"
#include "geometry/pose.h"
#include "metrics/harm_watch.h"
#include "motion/patient_motion.h"
#include "scoring/pain.h"
#include "storage/session_file.h"
#include "tasks/harm.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {

struct GunShot;

enum class AttemptPhase : std::uint8_t {
  kStarting,    ///< Servers start and load; `progress` is their progress.
  kReady,       ///< Forces are on, the needle is outside the skin.
  kInBody,      ///< The skin was pierced, the needle is inside.
  kServerLost,  ///< No data from the needle: its server or this machine is too slow or has failed; see `banner`.
  kStopped,     ///< The trainee stopped the forces; resume_forces() switches them on again.
  kFinishing,   ///< The attempt is being scored.
  kFinished,    ///< take_result() returns the score.
  kFailed,      ///< take_result() returns the error. The session file contains the recorded part.
};
const char* to_string(AttemptPhase phase) noexcept;

/// State of the virtual needle. Frame P.
struct NeedleView {
  bool is_known = false;      ///< A tick has arrived.
  double time_s = 0.0;        ///< Session time; 0 before recording.
  Pose X_PN;                  ///< Felt pose: tip and axis of the virtual needle, roll of the device.
  std::vector<Vec3> shaft_P;  ///< Hub to tip, see needle_shaft (attempt/guide/needle_view.h).
  Pose X_PN_goal;             ///< Target pose of the hand.
  double resistance_n = 0.0;  ///< Resistance along the needle; positive pushes it out.
  double lag_mm = 0.0;        ///< Distance of the virtual tip behind the hand's, along the axis.
  double depth_mm = 0.0;      ///< Depth of the tip below the skin.
  double speed_mm_s = 0.0;    ///< Speed along the axis; positive inward.
  /// Tissue at the tip: the label's name if there is a label, otherwise the tissue's; empty outside.
  std::string tissue;
  telemetry::InsertionPhase phase = telemetry::InsertionPhase::kOutside;
  bool is_clamped = false;
};

/// State of the virtual transducer. Frame P.
struct TransducerView {
  bool is_known = false;
  Pose X_PT;                ///< Felt pose: does not pass through the skin.
  Pose X_PT_goal;           ///< Target pose of the hand.
  double contact_n = 0.0;   ///< Contact force of skin and face.
  double pressed_mm = 0.0;  ///< Largest indentation of the skin.
  bool is_clamped = false;
};

/// State of a haptic server for the status bar.
struct ServerView {
  std::string tool;  ///< "needle", "probe"
  int pid = 0;
  bool is_connected = false;
  bool is_on = false;                     ///< Its forces are on, and the hand moves it.
  std::string device;                     ///< "virtual:premium"
  double rate_hz = 0.0, wanted_hz = 0.0;  ///< Achieved and requested tick rate.
  double p99_us = 0.0;                    ///< Lateness of its periods.
  std::uint64_t ticks_missing = 0;        ///< Ticks that the server made and this program did not receive.
  telemetry::GateMode gate = telemetry::GateMode::kOff;
  telemetry::GateFault fault = telemetry::GateFault::kNone;  ///< Fault of the safety gate.
  std::string grant;                                         ///< Real-time scheduling granted by the system.
  std::string warning;                                       ///< Warning of the server.
  bool waits_for_resume = false;  ///< Its forces are off until resume_forces(), although the user did not stop them.
  int restarts = 0;               ///< Number of restarts of the process and of recoveries without a restart.
};

/// A phase of the task for display, in the task's order.
struct PhaseView {
  std::string title;
  std::string why;    ///< The reason for it.
  std::string lacks;  ///< What is to be done next, one sentence; empty unless it is open and not done.
  bool is_open = false;
  std::optional<double> begun_s, done_s;  ///< Session time.
};

/// All data of an attempt displayed by a page at one time.
struct AttemptView {
  Clock::TimePoint made;  ///< When the loop published it.
  AttemptPhase phase = AttemptPhase::kStarting;
  std::string progress;            ///< Current activity in kStarting and kFinishing.
  double progress_fraction = 0.0;  ///< 0..1
  std::string banner;              ///< One line of high importance; empty: no problem.
  bool is_harm = false;            ///< The banner tells of harm to the patient.
  std::string recovered;           ///< Description of the last recovery of a server, one sentence.
  int recoveries = 0;              ///< Number of times that forces returned after a server ended or was unavailable.
  std::string message;             ///< Result of the last set_parameters(), or of a command.
  std::vector<PhaseView> phases;   ///< Empty in an exam, and for a task without phases.
  std::optional<std::size_t> current_phase;  ///< The first one that is open and not done.
  bool is_stylet_drawn = false, is_breath_held = false;
  double wire_mm = 0.0;          ///< Guide wire beyond the tip; 0: none in the needle.
  std::string hint;              ///< Instruction for the trainee (guided attempts only); may be empty.
  motion::PatientMotion motion;  ///< Where the patient was at the newest tick of the needle.
  NeedleView needle;
  TransducerView probe;
  bool has_probe = false;
  std::array<ServerView, 2> servers;  ///< Needle, probe.
  double session_s = 0.0;             ///< Recorded time so far, without interruptions.
  double since_contact_s = 0.0;  ///< Time since the needle first touched the skin, without interruptions; 0 before.
  /// Stopped by stop_forces(), or a server waits; resume_forces() switches them on again.
  bool are_forces_stopped = false;
  std::size_t shots = 0;  ///< Of the biopsy gun.
  bool is_gun_loaded = true;
  std::shared_ptr<const GunShot> shot;  ///< The last one; null: none.
  double since_shot_s = 0.0;            ///< Session time; stops while there are no data from the needle.
  bool is_performing = false;           ///< A scripted operator moves the needle.
  std::vector<std::string> notes;       ///< Problems during the attempt, in order.
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
  std::string name;                       ///< Name of the layer or label.
  std::string text;                       ///< "through the liver capsule at 1.9 N"
  tasks::Harm harm = tasks::Harm::kNone;  ///< What it did to the patient.
};

/// Display text of a tick's event: punctures, entered tissue, a needle resumed inside. Empty for other events.
std::optional<AttemptEvent> describe_event(const storage::SessionInfo& info, const telemetry::TickSample& sample,
                                           const telemetry::TickEvent& event);

/// The event of an action: "the stylet was drawn: bile drips from the hub". `patient`: tells why an injection of
/// anaesthetic numbs nothing; may be null.
AttemptEvent describe_action(const tasks::SubstanceTable& substances, const tasks::Action& action,
                             const anatomy::VirtualPatient* patient = nullptr);
/// "contrast agent: 1.5 ml (3.0 ml in all)"
AttemptEvent describe_injection(const tasks::ContrastInjection& injection, double depth_mm);
/// All actions and injections of an attempt by time, for its story.
std::vector<AttemptEvent> describe_actions(const tasks::SubstanceTable& substances, const storage::Session& session,
                                           const anatomy::VirtualPatient* patient);
/// The event "pain": "the patient feels pain: spinous process".
AttemptEvent describe_pain(const scoring::PainEvent& pain);
/// The event "harm": "critical harm: the needle went 2 mm into the heart", "grazed: …" at the moment `now`.
AttemptEvent describe_harm(const metrics::HarmEvent& harm, const telemetry::TickSample& now);

/// Thins ticks to the resolution of a plot: keeps the lowest and the highest force of each time interval (kStretch_s),
/// in their order. All peaks are kept, and a second has 150 points at most.
class ForceTrace {
 public:
  static constexpr double kStretch_s = 0.02;

  void add(const ForcePoint& point) {
    if (!has_any_) {
      begin(point);
      return;
    }
    if (point.force_n < low_.force_n) low_ = point;
    if (point.force_n > high_.force_n) high_ = point;
    last_ = point;
    if (point.time_s - from_s_ >= kStretch_s) flush();
  }
  /// Returns the points of the finished intervals; the current interval stays.
  std::vector<ForcePoint> take() { return std::exchange(points_, {}); }
  /// Ends the current interval.
  void flush() {
    if (!has_any_) return;
    const bool is_low_first = low_.time_s <= high_.time_s;
    const ForcePoint& first = is_low_first ? low_ : high_;
    const ForcePoint& second = is_low_first ? high_ : low_;
    points_.push_back(first);
    if (second.time_s > first.time_s) points_.push_back(second);
    if (last_.time_s > points_.back().time_s) points_.push_back(last_);
    has_any_ = false;
  }

 private:
  void begin(const ForcePoint& point) {
    low_ = high_ = last_ = point;
    from_s_ = point.time_s;
    has_any_ = true;
  }

  std::vector<ForcePoint> points_;
  ForcePoint low_, high_, last_;
  double from_s_ = 0.0;
  bool has_any_ = false;
};

}  // namespace trocar::attempt
