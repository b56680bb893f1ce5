#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.h"
#include "web/message.h"

namespace trocar::web {

struct ListenAddress {
  std::string host = "127.0.0.1";  ///< A number of IPv4 or IPv6 (without brackets), or "localhost".
  int port = 8080;                 ///< 0: any free port.

  /// Whether only programs of this machine reach it: 127.0.0.0/8, ::1, "localhost".
  bool is_loopback() const noexcept;
  /// Whether it stands for every address of the machine: 0.0.0.0, ::.
  bool is_any() const noexcept;
};

/// "HOST:PORT", "[::1]:PORT" or "PORT" (on 127.0.0.1). Error (exit status 2): no number of an address, no port from 0
/// to 65535.
Result<ListenAddress> parse_listen_address(std::string_view text);

/// A host as a URL shows it: IPv6 in brackets.
std::string url_host(const std::string& host);

}  // namespace trocar::web

struct ssl_ctx_st;

namespace trocar::web {

struct TlsFiles {
  std::filesystem::path certificate;  ///< PEM: the server's certificate, then those between it and the root.
  std::filesystem::path key;          ///< PEM, not encrypted.
};

/// The server's side of TLS 1.2 and 1.3, with forward secrecy and authenticated encryption only.
class TlsContext {
 public:
  /// Errors: a file is missing or is no PEM file, the key is another one, other users may read the key, the
  /// certificate has expired.
  static Result<TlsContext> load(const TlsFiles& files);

  /// Whether the certificate names this host (subjectAltName, wildcards too); `host` is a name or a number.
  bool names(const std::string& host) const;

  ssl_ctx_st* get() const noexcept { return context_.get(); }

 private:
  explicit TlsContext(std::shared_ptr<ssl_ctx_st> context) : context_(std::move(context)) {}
  std::shared_ptr<ssl_ctx_st> context_;
};

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
