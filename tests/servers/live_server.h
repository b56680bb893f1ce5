#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "core/files/folders.h"
#include "link/client/haptic_client.h"
#include "link/client/server_process.h"

namespace trocar::servers_test {

/// Long enough for a loaded machine; no measurement uses it.
inline constexpr std::chrono::milliseconds kPatience{60'000};

bool wait_for(const std::function<bool()>& is_so);

/// A trocar-hapticd with a simulated device on its own endpoint; ordinary scheduling, so that it does not block a core
/// for other tests.
class LiveServer {
 public:
  explicit LiveServer(std::vector<std::string> more = {});
  void start();
  void kill(int signal);
  link::ServerProcess& process() { return *process_; }
  const std::string& url() const { return url_; }
  const TemporaryFolder& folder() const { return folder_; }

 private:
  TemporaryFolder folder_;
  std::string url_;
  std::vector<std::string> arguments_;
  std::optional<link::ServerProcess> process_;
};

link::HapticClient connect(const std::string& url, bool wants_control = true);
/// The layered liver patient, entered vertically; the hand can be set by its depth below the skin.
link::LoadScene layers_scene();
link::HandTarget hand_at_depth(double depth_mm);
/// Loads the scene, presses the hand on the skin, turns the forces on and waits for the end of the safe start.
void press_on_skin(link::HapticClient& client, double* pressed_mm = nullptr);
/// A step of a hand that presses: slowly, as one that is thrown at the skin goes through it, and deeper while less than
/// `least_n` is felt, as the wall gives way under the needle. True if that much is felt.
bool keep_pressing(link::HapticClient& client, double least_n, double& depth_mm);
/// Tissue force on the device (N), without the weight of the stylus.
double felt_n(const telemetry::TickSample& sample);
bool has_limit(const telemetry::TickSample& sample, telemetry::LimitReason reason);

}  // namespace trocar::servers_test
