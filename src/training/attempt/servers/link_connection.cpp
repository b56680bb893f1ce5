#include "attempt/servers/link_connection.h"

#include <utility>

namespace trocar::attempt {
namespace {

class LinkConnection final : public ServerConnection {
 public:
  explicit LinkConnection(link::HapticClient client) : client_(std::move(client)) {}
  link::ClientView view() const override { return client_.view(); }
  std::vector<link::NumberedSample> take_samples() override { return client_.take_samples(); }
  std::optional<telemetry::TickSample> newest() const override { return client_.newest(); }
  std::uint32_t send(decltype(link::Command::what) what) override { return client_.send(std::move(what)); }
  std::vector<link::Reply> take_replies() override { return client_.take_replies(); }
  Result<std::string> ask(decltype(link::Command::what) what, std::chrono::milliseconds timeout) override {
    return client_.ask(std::move(what), timeout);
  }
  void set_target(const link::HandTarget& target) override { client_.set_hand(target); }
  void frame_drawn() override { client_.frame_drawn(); }

 private:
  link::HapticClient client_;
};

}  // namespace

Result<std::unique_ptr<ServerConnection>> connect_by_link(const link::ClientOptions& options) {
  TROCAR_TRY(link::HapticClient client, link::HapticClient::connect(options));
  return std::make_unique<LinkConnection>(std::move(client));
}

}  // namespace trocar::attempt
