#include "web/transport/http_server.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>

#include "core/start_thread.h"
#include "web/transport/detail/library_server.h"

namespace trocar::web {

struct HttpServer::State {
  State(ServerOptions server_options, Handler handler)
      : options(std::move(server_options)), server(options, std::move(handler)) {}
  ~State() {
    server.end();
    if (thread.joinable()) thread.join();
  }

  ServerOptions options;
  detail::LibraryServer server;
  int port = 0;
  std::thread thread;
};

HttpServer::HttpServer(std::unique_ptr<State> state) : state_(std::move(state)) {}
HttpServer::HttpServer(HttpServer&&) noexcept = default;
HttpServer& HttpServer::operator=(HttpServer&&) noexcept = default;
HttpServer::~HttpServer() = default;

Result<HttpServer> HttpServer::start(ServerOptions options, Handler handler) {
  auto state = std::make_unique<State>(std::move(options), std::move(handler));
  errno = 0;
  const auto port = state->server.bind();
  if (!port) {
    const ListenAddress& listen = state->options.listen;
    const std::string where = fmt::format("{}:{}", url_host(listen.host), listen.port);
    if (errno == EADDRINUSE)
      return fail("another program listens there", where, "choose another port with --listen, or end that program");
    if (errno == EACCES)
      return fail("ports below 1024 need more rights", where, "choose a port from 1024 on with --listen");
    return fail(errno == EADDRNOTAVAIL ? "not an address of this machine" : "cannot listen there", where,
                "choose an address of this machine with --listen");
  }
  state->port = *port;
  TROCAR_TRY(state->thread, start_thread("server", [server = &state->server] { server->serve(); }));
  while (!state->server.is_running()) std::this_thread::yield();
  return HttpServer(std::move(state));
}

void HttpServer::stop() {
  state_->server.end();
  if (state_->thread.joinable()) state_->thread.join();
}

int HttpServer::port() const noexcept {
  return state_->port;
}

std::string HttpServer::url() const {
  return fmt::format("{}://{}:{}", state_->options.tls ? "https" : "http", url_host(state_->options.listen.host),
                     state_->port);
}

}  // namespace trocar::web
