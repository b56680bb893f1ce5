#pragma once

#include "link/server_socket.h"
#include "server/detail/shared.h"
#include "server/flight_recorder.h"

namespace trocar::server {

/// The link thread: receives messages, sends batches, sends the status up to 20 times per second and feeds the flight
/// recorder.
class LinkThread {
 public:
  LinkThread(Shared& shared, link::ServerSocket& socket, link::Welcome welcome, int priority);
  void run();
  std::uint64_t ticks() const noexcept { return ticks_; }  ///< Valid after run() has returned.

 private:
  void receive_round();
  /// Forces off, if control has changed: another client, a new session of the same one, or nobody.
  void watch_control();
  void take(const link::Received& received);
  void take(const link::Received& received, const link::Command& command);
  void reply(const link::Received& received, std::uint32_t request, bool is_done, std::string text);
  void drain();
  void save(Flight flight);
  void flush();
  link::ServerStatus make_status(double now_s);
  std::string warning() const;

  Shared& shared_;
  link::ServerSocket& socket_;
  link::Welcome welcome_;
  int priority_;
  FlightRecorder recorder_;
  link::StateBatch batch_;
  ServoRecord newest_;
  std::uint64_t ticks_ = 0;
  std::uint64_t in_control_ = 0;  ///< Session of the client in control; 0: none.
  std::uint64_t placements_ = 0;  ///< See CountedHand.
  static constexpr double kNotPlaced_s = -1.0;
  double placed_s_ = kNotPlaced_s;  ///< Time of the last placement by this client.
  double pressed_mm_ = 0.0;         ///< Of the last placement.
  double window_age_s_ = 0.0;
  std::uint32_t actions_ = 0;
  double drop_n_ = 0.0, drop_s_ = 0.0;
  double coupling_share_ = 1.0;  ///< Smallest value since the last status.
  double sent_s_ = 0.0, told_s_ = 0.0;
};

}  // namespace trocar::server
