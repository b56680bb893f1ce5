#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include "cases/scene_request.h"
#include "core/files/folders.h"
#include "haptics/haptic_scene.h"
#include "link/client/haptic_client.h"
#include "link/client/server_process.h"

/// Live servers for benchmarks: a needle on a path of a case and a transducer on the skin, moved by simulated hands.
namespace trocar::bench {

/// A server process and its client.
struct Station {
  std::string tool;
  link::ServerProcess process;
  link::HapticClient client;
  double resident_mib = 0.0;  ///< When the measurement started.
};
using Stations = std::array<Station, 2>;  ///< Needle and transducer.

inline constexpr auto kPatience = std::chrono::seconds(60);

/// Starts both servers at a rate and places the hands. Their files are in `folder`. Errors: no server program, a server
/// that does not answer.
Result<Stations> start_stations(const TemporaryFolder& folder, const cases::Case& the_case, double rate_hz,
                                haptics::ForceModel model);

/// Moves both hands 200 times a second on a thread of its own, as a scripted operator would, until it is destroyed.
class MovingHands {
 public:
  MovingHands(Stations& stations, const cases::Case& the_case);
  ~MovingHands();
  MovingHands(const MovingHands&) = delete;
  MovingHands& operator=(const MovingHands&) = delete;

 private:
  std::atomic<bool> is_done_{false};
  std::thread thread_;
};

/// Computes three slices of 512 x 512 pixels through the tip, as a window with slice viewers does. Returns their sum,
/// so that the compiler keeps the work.
double draw_slices(const volume::CtGrid& ct, const Vec3& tip_P, const Vec3& axis_P);

}  // namespace trocar::bench
