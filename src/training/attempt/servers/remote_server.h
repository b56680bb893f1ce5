#pragma once

#include <optional>
#include <string>
#include <utility>

#include "attempt/servers/link_connection.h"
#include "attempt/servers/server_host.h"

namespace trocar::attempt {

/// A haptic server that was already running: it is not supervised as a process.
class RemoteServer final : public ServerHost {
 public:
  RemoteServer(std::string endpoint, std::optional<link::ClientSecurity> security)
      : endpoint_(std::move(endpoint)), security_(std::move(security)) {}

  const std::string& tool() const noexcept override { return unknown_; }
  const std::string& device() const noexcept override { return unknown_; }
  const std::string& endpoint() const noexcept override { return endpoint_; }
  int pid() const override { return 0; }
  Status check() override { return {}; }
  bool is_held_up() override { return false; }
  Status restart() override { return fail("this program did not start the server", endpoint_, "start it again"); }
  Result<std::unique_ptr<ServerConnection>> connect(link::ClientOptions options) override {
    options.endpoint = endpoint_;
    options.security = security_;
    return connect_by_link(options);
  }

 private:
  std::string endpoint_, unknown_;
  std::optional<link::ClientSecurity> security_;
};

}  // namespace trocar::attempt
