#pragma once

#include <filesystem>

#include "server/detail/shared.h"
#include "server/scene_builder.h"

namespace trocar::server {

/// The control thread: scenes, reconnecting, flight records; one job after the other, until the door is closed.
class Control {
 public:
  Control(Shared& shared, devices::HapticDevice& device, SceneBuilder builder, std::string tool,
          std::filesystem::path flight_folder);
  void run();

 private:
  /// What a reply says of a job that was done, in words.
  Result<std::string> perform(const ControlJob& job);
  Result<std::string> perform(const link::LoadScene& request);
  Result<std::string> perform(const link::SetParameters& request);
  Result<std::string> perform(link::ServerCommand command);
  Result<std::string> perform(const WriteFlight& flight);
  void publish(const ServoScene& scene);
  link::Reply make_reply(const ControlJob& job, const Result<std::string>& done) const;

  Shared& shared_;
  devices::HapticDevice& device_;
  SceneBuilder builder_;
  std::string tool_;
  std::filesystem::path flight_folder_;
  std::shared_ptr<const ServoScene> scene_;  ///< The one published last.
};

}  // namespace trocar::server
