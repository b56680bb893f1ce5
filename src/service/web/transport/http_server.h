#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

#include "core/result.h"
#include "web/message.h"
#include "web/transport/listen_address.h"
#include "web/transport/tls_context.h"

namespace trocar::web {

struct ServerOptions {
  ListenAddress listen;
  std::optional<TlsContext> tls;                    ///< Empty: HTTP without encryption.
  int threads = 256;                                ///< Connections at a time; more wait.
  int connections_per_address = 128;                ///< Or network, see client_of. Not counted on loopback.
  std::size_t body_bytes = std::size_t{256} << 10;  ///< Largest body of a request.
  std::chrono::milliseconds idle_time{15000};       ///< A connection without a request is closed.
  std::chrono::milliseconds header_time{5000};      ///< For a request's header, however its bytes come.
  std::chrono::milliseconds body_time{10000};       ///< For its body.
  TextPairs default_headers;                        ///< Of every answer, also of those to malformed requests.
};

/// A server of HTTP/1.1 over cpp-httplib with bounds for memory, time and connections. It reads requests completely and
/// calls one function for all of them, from several threads. Refused before that: malformed requests, chunked or
/// compressed bodies, two lengths of a body, paths of more than 1024 bytes, bodies above the limit.
class HttpServer {
 public:
  using Handler = std::function<HttpAnswer(const HttpRequest&)>;

  /// Binds and listens; the answers begin at once. Errors: the address is in use or is not this machine's, a port below
  /// 1024 without the right to it.
  static Result<HttpServer> start(ServerOptions options, Handler handler);
  HttpServer(HttpServer&&) noexcept;
  HttpServer& operator=(HttpServer&&) noexcept;
  ~HttpServer();

  /// Accepts no more, finishes running requests and ends.
  void stop();
  int port() const noexcept;
  /// "https://127.0.0.1:8443".
  std::string url() const;

 private:
  struct State;
  explicit HttpServer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace trocar::web
