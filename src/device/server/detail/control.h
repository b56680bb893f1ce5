#pragma once

#include <filesystem>

#include "server/detail/shared.h"
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

}  // namespace trocar::server
