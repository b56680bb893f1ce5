#include "web/transport/detail/library_server.h"

#include <netinet/tcp.h>
#include <sys/socket.h>

#include "core/log.h"
#include "web/security/request_guards.h"
#include "web/transport/detail/connection.h"

namespace trocar::web::detail {
namespace {

constexpr int kBacklog = 1024;
constexpr int kMostRequests = 1000;  ///< Of a connection.
constexpr std::size_t kMostPathBytes = 1024;
constexpr const char* kVersionWithChunks = "HTTP/1.1";
constexpr std::chrono::milliseconds kIdleSlice{250};  ///< An idle connection sees a stop of the server so soon.

enum Status { kBadRequest = 400, kLengthRequired = 411, kTooLarge = 413, kUriTooLong = 414, kUnsupportedMedia = 415 };

/// A request that is answered before its body is read, and whose connection then ends: its end cannot be trusted.
std::optional<int> find_refusal(const httplib::Request& request, std::size_t most_bytes) {
  if (request.target.size() > kMostPathBytes) return kUriTooLong;
  if (request.has_header("Transfer-Encoding")) return kLengthRequired;
  if (request.has_header("Content-Encoding")) return kUnsupportedMedia;
  const std::size_t lengths = request.get_header_value_count("Content-Length");
  if (lengths > 1) return kBadRequest;
  if (lengths == 0) return std::nullopt;
  const std::string length = request.get_header_value("Content-Length");
  if (length.empty() || length.find_first_not_of("0123456789") != std::string::npos) return kBadRequest;
  constexpr std::size_t kMostDigits = 12;
  if (length.size() > kMostDigits || std::stoull(length) > most_bytes) return kTooLarge;
  const bool has_no_body = request.method == "GET" || request.method == "HEAD";
  if (has_no_body && std::stoull(length) > 0) return kBadRequest;  // some versions of the library read it, some do not
  return std::nullopt;
}

std::size_t body_length(const httplib::Request& request) {
  return request.has_header("Content-Length") ? std::stoull(request.get_header_value("Content-Length")) : 0;
}

HttpAnswer answer_to_refused(int status) {
  switch (status) {
    case kUriTooLong:
      return error_answer(status, "the address is too long", "shorten it");
    case kLengthRequired:
      return error_answer(status, "the length of the body is missing", "send Content-Length, and no chunks");
    case kUnsupportedMedia:
      return error_answer(status, "the body is compressed", "send it without Content-Encoding");
    case kTooLarge:
      return error_answer(status, "the body is too large", "send less");
    default:
      return error_answer(status, "not a request of HTTP/1.1", "check the client");
  }
}

HttpRequest converted(const httplib::Request& request) {
  HttpRequest ours;
  ours.method = request.method;
  ours.path = request.target.substr(0, request.target.find_first_of("?#"));
  ours.query.assign(request.params.begin(), request.params.end());
  for (const auto& [name, value] : request.headers) ours.headers.emplace_back(name, value);
  ours.body = request.body;
  ours.address = request.remote_addr;
  return ours;
}

/// Sends all pieces. One call of the library does so: between two it would end with the server.
httplib::ContentProviderWithoutLength provider_of(ContentSource source) {
  return [source = std::move(source)](std::size_t, httplib::DataSink& sink) {
    while (true) {
      const Result<std::string> piece = source();
      if (!piece) {
        log(LogLevel::kError, fmt::format("web: an answer was cut off: {}", piece.error().text()));
        return false;
      }
      if (piece->empty()) {
        sink.done();
        return true;
      }
      if (!sink.write(piece->data(), piece->size())) return false;
    }
  };
}

void convert(HttpAnswer answer, httplib::Response& response, bool has_chunks = true) {
  response.status = answer.status;
  for (const auto& [name, value] : answer.headers) {
    response.headers.erase(name);  // a default
    response.set_header(name, value);
  }
  if (answer.source) {
    if (has_chunks) {
      response.set_chunked_content_provider(answer.content_type, provider_of(std::move(answer.source)));
    } else {
      response.set_content_provider(answer.content_type, provider_of(std::move(answer.source)));
    }
    return;
  }
  if (!answer.body || answer.body->empty()) return;
  response.set_content(*answer.body, answer.content_type);
}

}  // namespace

LibraryServer::LibraryServer(const ServerOptions& options, HttpServer::Handler handler)
    : options_(options), handler_(std::move(handler)) {
  limits_.header_time = options.header_time;
  limits_.body_time = options.body_time;
  new_task_queue = [this] { return new WorkerThreads(static_cast<std::size_t>(options_.threads), waiting_); };
  set_payload_max_length(options.body_bytes);
  // The library only names them in its header Keep-Alive.
  set_keep_alive_max_count(kMostRequests);
  set_keep_alive_timeout(std::chrono::ceil<std::chrono::seconds>(options.idle_time).count());
  set_socket_options([this](int socket) {
    listening_ = socket;
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof(yes));  // accepted sockets inherit it
  });
  httplib::Headers defaults;
  for (const auto& [name, value] : options.default_headers) defaults.emplace(name, value);
  set_default_headers(std::move(defaults));
  set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
    const auto refusal = find_refusal(request, options_.body_bytes);
    if (!refusal) return HandlerResponse::Unhandled;
    convert(answer_to_refused(*refusal), response);
    return HandlerResponse::Handled;
  });
  const auto all = [this](const httplib::Request& request, httplib::Response& response) { answer(request, response); };
  const std::string any = "[^]*";
  Get(any, all).Post(any, all).Put(any, all).Patch(any, all).Delete(any, all).Options(any, all);
  // Only for what the library refuses itself: our own answers have content.
  set_error_handler(HandlerWithResponse([](const httplib::Request&, httplib::Response& response) {
    if (response.has_header("Content-Length") || response.has_header("Content-Type")) return HandlerResponse::Unhandled;
    response.body.clear();
    const HttpAnswer ours = answer_to_refused(response.status);
    response.set_content(*ours.body, ours.content_type);
    return HandlerResponse::Handled;
  }));
  set_exception_handler([this](const httplib::Request&, httplib::Response& response, std::exception_ptr) {
    const LimitedLog limited(log_limit_);
    log(LogLevel::kError, "web: an exception ended a request");
    convert(error_answer(500, "the server failed", "try again"), response);
  });
}

std::optional<int> LibraryServer::bind() {
  int port = options_.listen.port;
  if (port == 0) {
    port = bind_to_any_port(options_.listen.host);
    if (port <= 0) return std::nullopt;
  } else if (!bind_to_port(options_.listen.host, port)) {
    return std::nullopt;
  }
  ::listen(listening_, kBacklog);  // the library's own backlog is 5
  return port;
}

void LibraryServer::end() {
  is_ending_ = true;
  stop();
}

void LibraryServer::answer(const httplib::Request& request, httplib::Response& response) const {
  convert(handler_(converted(request)), response, request.version == kVersionWithChunks);
}

bool LibraryServer::count_in(const std::string& address) {
  if (address == "127.0.0.1" || address == "::1") return true;
  const std::lock_guard lock(mutex_);
  int& count = connections_[client_of(address)];
  if (count >= options_.connections_per_address) return false;
  ++count;
  return true;
}

void LibraryServer::count_out(const std::string& address) {
  const std::lock_guard lock(mutex_);
  const auto found = connections_.find(client_of(address));
  if (found != connections_.end() && --found->second <= 0) connections_.erase(found);
}

bool LibraryServer::process_and_close_socket(socket_t socket) {
  Connection connection(socket, options_.tls ? options_.tls->get() : nullptr, limits_);
  std::string address;
  int port = 0;
  connection.get_remote_ip_and_port(address, port);
  if (!count_in(address)) return false;
  try {
    if (connection.shake_hands()) converse(connection);
  } catch (const std::exception& error) {
    const LimitedLog limited(log_limit_);
    log(LogLevel::kError, fmt::format("web: a connection ended: {}", error.what()));
  }
  count_out(address);
  return true;
}

bool LibraryServer::process(Connection& connection, bool is_last, bool& is_closed,
                            const std::function<void(httplib::Request&)>& set_up) {
  // Newer versions of the library are told both addresses, and ask the connection no more.
  const auto call = [&](auto& server) {
    if constexpr (requires { server.process_request(connection, is_last, is_closed, set_up); }) {
      return server.process_request(connection, is_last, is_closed, set_up);
    } else {
      std::string remote, local;
      int remote_port = 0, local_port = 0;
      connection.get_remote_ip_and_port(remote, remote_port);
      connection.get_local_ip_and_port(local, local_port);
      return server.process_request(connection, remote, remote_port, local, local_port, is_last, is_closed, set_up);
    }
  };
  return call(*this);
}

void LibraryServer::converse(Connection& connection) {
  for (int n = 0; n < kMostRequests; ++n) {
    // Requests that are there already are answered even if the server ends.
    auto left = options_.idle_time;
    bool has_request = connection.has_request(std::chrono::milliseconds(1));
    while (!has_request && left.count() > 0 && !is_ending_ && waiting_ == 0 && !connection.is_closed_by_client()) {
      has_request = connection.has_request(std::min(left, kIdleSlice));
      left -= kIdleSlice;
    }
    if (!has_request) return connection.is_closed_by_client() ? void() : connection.close_gently();
    connection.begin_header();
    bool is_last = n + 1 == kMostRequests || is_ending_ || waiting_ > 0;
    bool is_understood = false, is_closed = false;
    const bool is_done = process(connection, is_last, is_closed, [&](httplib::Request& request) {
      is_understood = true;
      request.headers.erase("Accept-Encoding");  // the library would compress every answer anew
      request.ranges.clear();
      const auto refusal = find_refusal(request, options_.body_bytes);
      if (refusal) request.set_header("Connection", "close");
      // The end of the connection is the end of an answer without length.
      const bool has_chunks = request.version == kVersionWithChunks;
      if (!has_chunks) request.set_header("Connection", "close");
      is_closed = is_closed || refusal.has_value() || !has_chunks;
      connection.begin_body(refusal ? 0 : body_length(request));
    });
    const bool is_sent = connection.flush();
    if (is_understood && !is_done) return connection.cut();
    const bool goes_on = is_done && is_sent && is_understood && !is_last && !is_closed && !connection.has_unread_body();
    if (!goes_on) return connection.close_gently();
  }
}

}  // namespace trocar::web::detail
