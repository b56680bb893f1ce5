#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <string>

#include "core/log.h"
#include "web/transport/detail/connection.h"
#include "web/transport/http_server.h"

namespace trocar::web::detail {

/// cpp-httplib's server on our connections: keep-alive, limits and TLS are ours, the messages are the library's.
class LibraryServer final : public httplib::Server {
 public:
  LibraryServer(const ServerOptions& options, HttpServer::Handler handler);

  /// Binds; on success the port. `errno` tells the reason otherwise.
  std::optional<int> bind();
  void serve() { listen_after_bind(); }
  void end();

 private:
  bool process_and_close_socket(socket_t socket) override;
  void converse(Connection& connection);
  bool process(Connection& connection, bool is_last, bool& is_closed,
               const std::function<void(httplib::Request&)>& set_up);
  void answer(const httplib::Request& request, httplib::Response& response) const;
  bool count_in(const std::string& address);
  void count_out(const std::string& address);

  const ServerOptions& options_;
  HttpServer::Handler handler_;
  ConnectionLimits limits_;
  int listening_ = -1;
  std::atomic<bool> is_ending_{false};
  std::atomic<int> waiting_{0};  ///< Connections that wait for a thread.
  LogLimit log_limit_;           ///< Of lines that a connection can cause.
  std::mutex mutex_;
  std::map<std::string, int> connections_;  ///< By client_of the address.
};

}  // namespace trocar::web::detail
