#pragma once

#include <filesystem>

#include "link/server_socket.h"
#include "server/detail/shared.h"
#include "server/flight_recorder.h"
#include "server/scene_builder.h"

namespace trocar::server {

/// The control thread: builds scenes, reconnects the device and writes flight records. It runs one job at a time, until
/// the ControlQueue is closed.
class Control {
 public:
  Control(Shared& shared, devices::HapticDevice& device, SceneBuilder builder, std::string tool,
          std::filesystem::path flight_folder);
  void run();
  /// States in log and status if flight records cannot be written. Call it before run().
  void check_flights();
  /// Writes a flight record. May be called by another thread while run() loads a scene.
  Result<std::string> write(const Flight& flight);

 private:
  /// Runs a job. Returns the text of the reply.
  Result<std::string> perform(const ControlJob& job);
  Result<std::string> perform(const link::LoadScene& request);
  Result<std::string> perform(const link::SetParameters& request);
  Result<std::string> perform(link::ServerCommand command);
  Result<std::string> perform(const Flight& flight) { return write(flight); }
  void publish(const ServoScene& scene);
  link::Reply make_reply(const ControlJob& job, const Result<std::string>& done) const;

  Shared& shared_;
  devices::HapticDevice& device_;
  SceneBuilder builder_;
  std::string tool_;
  const std::filesystem::path flight_folder_;
  std::shared_ptr<const ServoScene> scene_;  ///< Scene that was published last.
};

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
