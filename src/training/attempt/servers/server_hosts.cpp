#include "attempt/servers/server_hosts.h"

#include <fmt/format.h>

#include <fstream>
#include <utility>

namespace trocar::attempt {
namespace {

constexpr const char* kLog = "log";

std::string last_line(const std::filesystem::path& log) {
  std::ifstream file(log);
  std::string last;
  for (std::string line; std::getline(file, line);)
    if (!line.empty()) last = line;
  return last;
}

}  // namespace

std::optional<Error> error_of_line(std::string_view line) {
  constexpr std::string_view kMark = "error: ", kBetween = " — ";
  if (!line.starts_with(kMark)) return std::nullopt;
  line.remove_prefix(kMark.size());
  const std::size_t first = line.find(kBetween), last = line.rfind(kBetween);
  if (first == std::string_view::npos) return Error{std::string(line), {}, {}};
  const std::string what(line.substr(0, first)), advice(line.substr(last + kBetween.size()));
  const std::size_t begin = first + kBetween.size();
  return Error{what, first == last ? std::string() : std::string(line.substr(begin, last - begin)), advice};
}

Result<std::unique_ptr<LocalServer>> LocalServer::start(const LocalServerOptions& options) {
  std::unique_ptr<LocalServer> server(new LocalServer);
  server->options_ = options;
  server->folder_ = std::make_unique<TemporaryFolder>();
  server->endpoint_ = "ipc://" + (*server->folder_ / options.tool).string();
  TROCAR_TRY_STATUS(server->restart());
  return server;
}

Result<std::unique_ptr<ServerConnection>> LocalServer::connect(link::ClientOptions options) {
  options.endpoint = endpoint_;
  return connect_by_link(options);
}

Status LocalServer::restart() {
  TROCAR_TRY(const std::filesystem::path program, link::find_server_program());
  const std::string flights = options_.flight_folder.empty() ? "." : options_.flight_folder.string();
  const std::vector<std::string> arguments{"--device",         options_.device,
                                           "--tool",           options_.tool,
                                           "--rate",           fmt::format("{}", options_.rate_hz),
                                           "--priority",       fmt::format("{}", options_.priority),
                                           "--endpoint",       endpoint_,
                                           "--flight-records", flights};
  process_.reset();
  TROCAR_TRY(link::ServerProcess process, link::ServerProcess::start(program, arguments, *folder_ / kLog));
  process_ = std::make_unique<link::ServerProcess>(std::move(process));
  return {};
}

Status LocalServer::check() {
  if (process_ && process_->is_running()) return {};
  const std::string last = last_line(*folder_ / kLog);
  if (auto told = error_of_line(last)) return tl::unexpected(*std::move(told));
  return fail(fmt::format("the server of the {} {}", options_.tool,
                          process_ ? process_->how_it_ended() : "could not be started again"),
              last.empty() ? "trocar-hapticd" : "trocar-hapticd, which said last: " + last,
              "start the attempt again; what was recorded is kept");
}

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
