#pragma once

#include <chrono>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "attempt/live/attempt_view.h"
#include "attempt/servers/server_host.h"
#include "attempt/servers/server_seat.h"

namespace trocar::attempt {

/// How a device goes to where an attempt wants it.
enum class DeviceHold {
  kOurHand,   ///< Moved by hand targets: "virtual…", "mouse".
  kPlaced,    ///< Moves itself, can be put somewhere: "gamepad", "spacemouse".
  kRealHand,  ///< In a person's hand.
};
DeviceHold device_hold(const std::string& device_spec);

/// One tool's haptic server, process and seat: brought up, and brought back when it ends, falls silent or latches a
/// fault. A server that is only slow is waited for: as long as its process is stopped or wants a processor, up to
/// kMostPatience times the patience. A device that was unplugged is opened again as soon as it is back. A device in a
/// real hand gets no forces again by itself after a fault: somebody must resume. Nothing waits.
class ToolServer {
 public:
  /// Host and clock must outlive it.
  ToolServer(ServerHost& host, std::chrono::milliseconds patience, bool has_window, Clock& clock);

  void hold(const SeatRequest& request);
  void place_at(const Pose& X_PN);  ///< Where it is put when it comes back.
  /// One step. Gives what happened that is worth a note; empty: nothing.
  std::string look();
  /// Seated, forces on (unless stopped), and a tick was taken within the last 250 ms: else nobody knows where the tool
  /// is now.
  bool is_on() const noexcept;
  bool has_given_up() const noexcept { return has_given_up_; }
  const Error& failure() const noexcept { return failure_; }  ///< Why it has given up.
  const std::string& banner() const noexcept { return banner_; }
  /// Once, when the forces are back after an interruption: a sentence that says after which. Empty: nothing new.
  std::string take_recovery() { return std::exchange(recovery_, {}); }
  double loading() const noexcept { return seat_ ? seat_->loading() : 0.0; }
  std::string doing() const;  ///< "loading the patient", for a progress line.

  std::vector<link::NumberedSample> take_samples();
  /// The scenes of the ticks that take_samples() gives; null while there is no seat.
  const KnownScenes* scenes() const noexcept { return seat_ ? &seat_->scenes() : nullptr; }
  int seatings() const noexcept { return seatings_; }  ///< How often its forces came on, the tool put to its place.
  void set_hand(const link::HandTarget& target);
  /// As SetParameters means them. Sent now, and what holds then again whenever the server comes back, before its forces
  /// do. What is said of them comes by take_messages().
  void set_parameters(const std::vector<std::string>& settings);
  std::vector<std::string> take_messages();
  void stop_forces();
  void resume_forces();
  void frame_drawn();
  void end();  ///< Forces off; waits for the answer, half a second at most.

  double clock_offset_s() const noexcept { return seat_ ? seat_->view().clock_offset_s : 0.0; }
  double wanted_hz() const noexcept { return seat_ ? seat_->view().status.loop.wanted_hz : 0.0; }
  const link::ClientView& client() const;
  ServerView view() const;
  ServerFigures figures() const;

 private:
  void connect();
  std::string give_up(Error why);
  std::string bring_back(const std::string& what, bool is_new_process);
  std::string seat_again(bool is_new_process);
  bool is_device_lost() const;
  bool is_slow() const;
  std::string cannot_go_on(const Error& why);
  std::string note_interruption();
  std::string open_device_again();
  std::string device_words() const;  ///< "gamepad"
  /// All that was set since the scene was loaded.
  link::SetParameters parameters() const;
  void note_replies();

  ServerHost* host_;
  Clock* clock_;
  std::chrono::milliseconds patience_;
  bool has_window_;
  bool is_real_hand_;
  std::string tool_;
  std::optional<ServerSeat> seat_;
  std::optional<SeatRequest> request_;
  std::string banner_;
  std::string recovery_;
  std::string interrupted_by_;   ///< Since the forces were last on; empty: nothing.
  bool is_restart_due_ = false;  ///< Announced; the next look starts the process.
  Error failure_;
  /// What was set since the scene was loaded.
  struct Settings {
    std::vector<std::string> tissues;          ///< Of the last message that named any.
    std::map<std::string, std::string> other;  ///< "force_model=proxy", by key.
  };
  Settings settings_;
  std::map<std::uint32_t, Settings> before_;  ///< What held before a message that is not answered yet.
  std::vector<std::string> messages_;
  std::deque<Clock::TimePoint> returns_;  ///< Of the last minute.
  Clock::TimePoint ticked_;               ///< When a tick was last taken.
  Clock::TimePoint held_up_;              ///< When it was last heard, or its process had no processor.
  int stalls_ = 0;                        ///< Of the seat, as far as they were told.
  int restarts_ = 0, seatings_ = 0;
  std::uint64_t missing_before_ = 0;  ///< By seats that were given up.
  bool was_on_ = false;               ///< Since the seat was taken.
  bool was_ever_heard_ = false;
  bool is_stopped_ = false;
  bool has_given_up_ = false;
  bool waits_for_resume_ = false;
  /// The device is gone, its server is not.
  struct LostDevice {
    std::optional<std::uint32_t> asked;  ///< To open it again; not answered yet.
    Clock::TimePoint refused;            ///< When it was last not there.
  };
  std::optional<LostDevice> lost_device_;
};

}  // namespace trocar::attempt
