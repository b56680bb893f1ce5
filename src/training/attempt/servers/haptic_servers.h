#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "attempt/servers/server_hosts.h"
#include "attempt/servers/server_supervisor.h"
#include "core/progress.h"

namespace trocar::attempt {

/// Supervisors of an attempt's servers. The servers must outlive them.
struct ToolSupervisors {
  std::unique_ptr<ServerSupervisor> needle, transducer;  ///< No transducer: null.
};

/// The haptic servers of an attempt: the needle's, and optionally the transducer's. If they are kept between attempts,
/// they need not reopen the patient. Only one attempt uses them at a time.
class HapticServers {
 public:
  /// `transducer` may be null.
  HapticServers(std::unique_ptr<ServerHost> needle, std::unique_ptr<ServerHost> transducer);

  /// Starts processes. Errors: no trocar-hapticd, it cannot be started.
  static Result<std::shared_ptr<HapticServers>> start(const LocalServerOptions& needle,
                                                      const std::optional<LocalServerOptions>& transducer);
  /// True if start() with these options would create equivalent servers.
  bool fits(const LocalServerOptions& needle, const std::optional<LocalServerOptions>& transducer) const;

  ToolSupervisors supervise(const SupervisionOptions& options, Clock& clock);

 private:
  std::unique_ptr<ServerHost> needle_, transducer_;
  /// Options of the processes that start() created.
  std::optional<LocalServerOptions> needle_options_, transducer_options_;
};

/// Servers that were identified by their replies, connected and idle.
struct IdentifiedServers {
  std::shared_ptr<HapticServers> servers;
  ToolSupervisors supervisors;
};

/// Connects to servers in any order and identifies them by their tool; polls them until each is idle. Errors: a server
/// that fails, two servers of one tool, no needle server, an interruption of the program.
Result<IdentifiedServers> identify_servers(std::vector<std::unique_ptr<ServerHost>> hosts,
                                           const SupervisionOptions& options, Clock& clock, const Progress& progress);

/// A device that can move a tool.
struct ToolDevice {
  std::string spec;   ///< In the form of trocar-hapticd --device.
  std::string title;  ///< "Left Device (OpenHaptics)"
};

/// Devices that can be chosen: mouse and keys, pointing devices, and haptic devices. OpenHaptics has one entry for each
/// device that the vendor's setup program lists by name ($GTDD_HOME/config or /usr/share/3DSystems/config, a file
/// NAME.config each); without any, one for its default device. The list also contains devices that are not plugged in.
std::vector<ToolDevice> tool_devices();
/// Title of any device, also of one that is not listed.
std::string device_title(const std::string& spec);

/// True if needle and transducer can use these two devices together. Mouse and keys (and simulated devices) move both
/// tools; any other device is one piece of hardware in one hand.
bool can_be_used_together(const std::string& needle_spec, const std::string& probe_spec);

}  // namespace trocar::attempt
