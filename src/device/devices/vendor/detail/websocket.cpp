#include "devices/vendor/detail/websocket.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <exception>
#include <utility>

#include "core/text.h"

namespace trocar::devices {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostHostBytes = 253;  // timeout of the DNS lookup

bool is_host(std::string_view host) {
  return !host.empty() && host.size() <= kMostHostBytes && std::all_of(host.begin(), host.end(), [](char c) {
    return ascii::is_letter_or_digit(c) || c == '.' || c == '-' || c == '_';
  });
}

bool is_port(std::string_view port) {
  constexpr std::size_t kMostDigits = 5;
  return !port.empty() && port.size() <= kMostDigits && std::all_of(port.begin(), port.end(), ascii::is_digit);
}

}  // namespace

Result<WebSocketAddress> parse_websocket_address(std::string_view text) {
  constexpr std::string_view kScheme = "ws://";
  WebSocketAddress address;
  std::string_view rest = text;
  if (!rest.starts_with(kScheme)) {
    return fail_usage("not a WebSocket address", std::string(text), "write ws://localhost:10001");
  }
  rest.remove_prefix(kScheme.size());
  const std::size_t slash = rest.find('/');
  if (slash != std::string_view::npos) {
    address.path = rest.substr(slash);
    rest = rest.substr(0, slash);
  }
  const std::size_t colon = rest.find(':');
  address.host = rest.substr(0, colon);
  if (colon != std::string_view::npos) address.port = rest.substr(colon + 1);
  const bool has_plain_path =
      std::all_of(address.path.begin(), address.path.end(), [](unsigned char c) { return std::isgraph(c) != 0; });
  if (!is_host(address.host) || !is_port(address.port) || !has_plain_path) {
    return fail_usage("not a WebSocket address", std::string(text), "write ws://localhost:10001");
  }
  return address;
}

/// Declared first, destroyed last: the context owns handlers that were never called.
struct WebSocket::Connection {
  asio::io_context context;
  beast::websocket::stream<beast::tcp_stream> stream{context};
  beast::flat_buffer buffer;
  bool is_reading = false;
  bool has_read = false;
  error_code read_error;

  /// Runs until `is_done` or the timeout.
  void work(const bool& is_done, Clock::time_point deadline) {
    context.restart();
    while (!is_done && context.run_one_until(deadline) != 0) {
    }
  }
  /// Starts an operation with a handler of (error_code, ...) and waits for it, up to the timeout.
  template <class Start>
  error_code finish(std::chrono::milliseconds limit, Start&& start) {
    bool is_done = false;
    error_code outcome;
    start([&is_done, &outcome](error_code error, auto&&...) {
      is_done = true;
      outcome = error;
    });
    work(is_done, Clock::now() + limit);
    if (!is_done) {
      drop();
      outcome = asio::error::timed_out;
      while (!is_done) {  // cancelled: the handler must be called before it goes out of scope
        context.restart();
        if (context.run_one() == 0) break;
      }
    }
    return outcome;
  }
  void drop() noexcept { beast::get_lowest_layer(stream).close(); }

  void start_reading() {
    is_reading = true;
    has_read = false;
    stream.async_read(buffer, [this](error_code error, std::size_t) {
      is_reading = false;
      has_read = true;
      read_error = error;
    });
  }
};

WebSocket::WebSocket(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}

WebSocket::~WebSocket() {
  connection_->drop();
}

Result<std::unique_ptr<WebSocket>> WebSocket::connect(const WebSocketAddress& address, std::size_t most_bytes,
                                                      std::chrono::milliseconds limit) {
  std::string reason;
  try {
    auto connection = std::make_unique<Connection>();
    beast::websocket::stream<beast::tcp_stream>& stream = connection->stream;
    error_code error;
    asio::ip::tcp::resolver resolver(connection->context);
    const auto ends = resolver.resolve(address.host, address.port, error);
    if (!error) {
      error = connection->finish(
          limit, [&](auto handler) { beast::get_lowest_layer(stream).async_connect(ends, std::move(handler)); });
    }
    if (!error) {
      beast::get_lowest_layer(stream).expires_never();  // the WebSocket's own timeouts apply from here on
      beast::get_lowest_layer(stream).socket().set_option(asio::ip::tcp::no_delay(true), error);
      stream.set_option(beast::websocket::stream_base::timeout{limit, beast::websocket::stream_base::none(), false});
      stream.read_message_max(most_bytes);
      stream.text(true);
      const std::string host = fmt::format("{}:{}", address.host, address.port);
      error = connection->finish(limit,
                                 [&](auto handler) { stream.async_handshake(host, address.path, std::move(handler)); });
    }
    if (!error) return std::unique_ptr<WebSocket>(new WebSocket(std::move(connection)));
    reason = error.message();
  } catch (const std::exception& exception) {
    reason = exception.what();
  }
  return fail(fmt::format("no WebSocket connection: {}", reason), address.text(),
              "start the service of the device, or correct the address");
}

WebSocket::Received WebSocket::receive(std::string& message, std::chrono::milliseconds limit) {
  Connection& c = *connection_;
  if (!c.is_reading && !c.has_read) c.start_reading();
  c.work(c.has_read, Clock::now() + limit);
  if (!c.has_read) return Received::kNothingYet;
  if (c.read_error) return Received::kClosed;  // has_read remains set: the connection stays closed
  const asio::const_buffer bytes = c.buffer.cdata();
  message.assign(static_cast<const char*>(bytes.data()), bytes.size());
  c.buffer.consume(bytes.size());
  c.has_read = false;
  return Received::kMessage;
}

bool WebSocket::send(std::string_view message, std::chrono::milliseconds limit) {
  Connection& c = *connection_;
  const asio::const_buffer bytes(message.data(), message.size());
  return !c.finish(limit, [&](auto handler) { c.stream.async_write(bytes, std::move(handler)); });
}

void WebSocket::close(std::chrono::milliseconds limit) {
  Connection& c = *connection_;
  if (!c.stream.is_open()) return;
  c.finish(limit,
           [&](auto handler) { c.stream.async_close(beast::websocket::close_code::normal, std::move(handler)); });
}

}  // namespace trocar::devices
