#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "attempt/servers/server_host.h"
#include "core/testing/fake_clock.h"
#include "devices/haptic_device.h"
#include "link/testing/in_process_link.h"
#include "realtime/loop_statistics.h"
#include "server/scene_builder.h"
#include "server/servo.h"
#include "server/servo_commands.h"

namespace trocar::servers_test {

/// A haptic server in simulated time and in the test's thread. Servo, safety gate, scenes, devices, sessions and client
/// are the real ones; thread scheduling, socket and process are simulated. It runs the work of a link thread and of a
/// real-time thread in the order of trocar-hapticd.
class SimulatedServer {
 public:
  struct Options {
    std::string tool = "needle";
    std::string device = "virtual:premium";  ///< virtual:PRESET | mouse
    double start_s = 0.3;                    ///< Time from the start of the process to its first message.
    double load_s = 0.1;                     ///< Time to load a scene.
  };
  SimulatedServer(testing::FakeClock& clock, std::shared_ptr<const anatomy::VirtualPatient> patient, Options options);
  ~SimulatedServer();
  SimulatedServer(const SimulatedServer&) = delete;
  SimulatedServer& operator=(const SimulatedServer&) = delete;

  /// For HapticServers. The server must outlive it.
  std::unique_ptr<attempt::ServerHost> host();

  // The process.
  void pause() { is_paused_ = true; }  ///< SIGSTOP: it gets no processor time.
  void go_on() { is_paused_ = false; }
  void hang() { is_hung_ = true; }  ///< It sleeps without further work.
  void kill();                      ///< SIGKILL.
  Status restart();
  int pid() const { return pid_; }
  int restarts() const { return pid_ - kFirstPid; }
  /// The client's program gets no processor time: its thread neither reads nor sends heartbeats.
  void stall_client(bool is_stalled) { is_client_stalled_ = is_stalled; }

  // The device.
  void unplug() { is_plugged_ = false; }
  void plug() { is_plugged_ = true; }

 private:
  class Host;
  class Connection;
  class Device;
  static constexpr int kFirstPid = 1000;
  struct Job {
    std::uint64_t session = 0;
    std::uint32_t request = 0;
    decltype(link::Command::what) what;
    double due_s = 0.0;
  };
  /// State that ends with a process.
  struct Process;

  void step();
  double now_s() const;
  void receive(double now_s);
  void take(const link::Received& received, const link::Command& command, double now_s);
  /// Forces off, if control has changed.
  void watch_control(double now_s);
  void run_periods(double now_s);
  void run_period(double now_s, double dt_s);
  void run_jobs(double now_s);
  link::Reply perform(const Job& job);
  void add(const server::ServoRecord& record);
  void flush();
  link::ServerStatus status(double now_s) const;
  link::Welcome welcome() const;

  testing::FakeClock& clock_;
  std::shared_ptr<const anatomy::VirtualPatient> patient_;
  Options options_;
  std::string endpoint_;
  testing::InProcessServerEnd link_;
  std::vector<testing::InProcessClient*> clients_;
  std::unique_ptr<Process> process_;           ///< Null: it was killed.
  std::shared_ptr<const void> participation_;  ///< Handle of its participation in the clock.
  int pid_ = kFirstPid;
  bool is_paused_ = false, is_hung_ = false, is_client_stalled_ = false, is_plugged_ = true;
};

}  // namespace trocar::servers_test
