#include "link/client/detail/client_thread.h"

#include <sys/eventfd.h>
#include <sys/random.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core/log.h"
#include "core/start_thread.h"
#include "link/codec.h"
#include "realtime/periodic_loop.h"

namespace trocar::link::detail {
namespace {

constexpr int kMostWaitingOut = 200;  ///< Messages that the server does not accept [assumed: 2 s of heartbeats].
constexpr int kMostWaitingIn = 1000;  ///< [assumed: ten seconds of batches at 100 Hz]
constexpr int kMostReadAtOnce = 256;  ///< Messages between two checks of the clock [assumed].
constexpr int kReconnect_ms = 20, kReconnectMost_ms = 200, kHandshake_ms = 2000;
constexpr int kGoodbye_ms = 50;  ///< Timeout for sending Goodbye.
constexpr std::size_t kRoutingIdBytes = 16;

double steady_s() {
  return realtime::seconds(realtime::now_ns());
}

/// Random: the server identifies clients by it, and others cannot guess it. The first byte 0 is reserved for the
/// library.
std::string make_routing_id() {
  std::string id(kRoutingIdBytes, '\0');
  while (::getrandom(id.data(), id.size(), 0) != static_cast<ssize_t>(id.size())) {
  }
  id.front() = 'T';
  return id;
}

void drain(int descriptor) {
  std::uint64_t count = 0;
  while (::read(descriptor, &count, sizeof count) > 0) {
  }
}

bool has_keys_set(ZmqSocket& socket, const ClientSecurity& security) {
  return socket.set_key(ZMQ_CURVE_SERVERKEY, security.server_key) &&
         socket.set_key(ZMQ_CURVE_PUBLICKEY, security.keys.public_key) &&
         socket.set_key(ZMQ_CURVE_SECRETKEY, security.keys.secret_key);
}

}  // namespace

Result<std::unique_ptr<ClientThread>> ClientThread::start(const ClientOptions& options) {
  std::unique_ptr<ClientThread> client(new ClientThread(options));
  TROCAR_TRY_STATUS(client->open());
  TROCAR_TRY(client->thread_, start_thread("link", [self = client.get()] { self->run(); }));
  return client;
}

ClientThread::ClientThread(const ClientOptions& options)
    : options_(options), frame_drawn_ns_(realtime::now_ns()), routing_id_(make_routing_id()) {}

ClientThread::~ClientThread() {
  mailbox_.leave();
  wake();
  if (thread_.joinable()) thread_.join();
  if (wake_ >= 0) ::close(wake_);
  if (clock_ >= 0) ::close(clock_);
}

Status ClientThread::open() {
  constexpr int kThreads = 3;  // two of ZeroMQ, which aborts the program if one does not start, and this one's
  TROCAR_TRY_STATUS(check_threads_can_start("link", kThreads));
  wake_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  clock_ = ::timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK);
  // The first heartbeat at once, the others on its grid.
  itimerspec beats{};
  beats.it_interval.tv_nsec = kBeat_ns;
  beats.it_value.tv_nsec = 1;
  if (wake_ < 0 || clock_ < 0 || ::timerfd_settime(clock_, 0, &beats, nullptr) != 0) {
    return fail("no clock for the link", options_.endpoint, std::strerror(errno));
  }
  return open_socket();
}

Status ClientThread::open_socket() {
  socket_ = ZmqSocket(context_, ZMQ_DEALER);
  const bool is_set =
      socket_.is_open() && socket_.set(ZMQ_LINGER, 0) && socket_.set_text(ZMQ_ROUTING_ID, routing_id_) &&
      // Messages for a missing server are not queued: only present heartbeats are useful.
      socket_.set(ZMQ_IMMEDIATE, 1) && socket_.set(ZMQ_SNDHWM, kMostWaitingOut) &&
      socket_.set(ZMQ_RCVHWM, kMostWaitingIn) &&
      socket_.set_long(ZMQ_MAXMSGSIZE, static_cast<std::int64_t>(kMostMessageBytes)) &&
      socket_.set(ZMQ_RECONNECT_IVL, kReconnect_ms) && socket_.set(ZMQ_RECONNECT_IVL_MAX, kReconnectMost_ms) &&
      socket_.set(ZMQ_HANDSHAKE_IVL, kHandshake_ms) &&
      socket_.set(ZMQ_IPV6, options_.endpoint.find('[') == std::string::npos ? 0 : 1);
  if (!is_set) return fail("no socket", options_.endpoint, zmq_strerror(zmq_errno()));
  if (options_.security && !has_keys_set(socket_, *options_.security)) {
    return fail_usage("invalid CURVE keys", options_.endpoint, "make new ones with `trocar link keygen`");
  }
  handshakes_.watch(context_, socket_);
  if (zmq_connect(socket_.get(), options_.endpoint.c_str()) != 0) {
    return fail("the endpoint cannot be used", options_.endpoint, zmq_strerror(zmq_errno()));
  }
  beat_.reset();
  return {};
}

void ClientThread::wake() noexcept {
  const std::uint64_t one = 1;
  // This fails only if the counter is full, and then the thread is awake.
  [[maybe_unused]] const ssize_t written = ::write(wake_, &one, sizeof one);
}

void ClientThread::frame_drawn() noexcept {
  frame_drawn_ns_.store(realtime::now_ns(), std::memory_order_relaxed);
}

void ClientThread::run() {
  while (true) {
    // Handshake events are checked with every heartbeat.
    std::array<zmq_pollitem_t, 3> items{
        {{socket_.get(), 0, ZMQ_POLLIN, 0}, {nullptr, clock_, ZMQ_POLLIN, 0}, {nullptr, wake_, ZMQ_POLLIN, 0}}};
    // A socket that could not be opened is retried at the next heartbeat.
    const int first = socket_.is_open() ? 0 : 1;
    zmq_poll(items.data() + first, static_cast<int>(items.size()) - first, -1);
    read_messages();
    send_stops();
    if ((items[2].revents & ZMQ_POLLIN) != 0) {
      drain(wake_);
      Outgoing outgoing = mailbox_.take_outgoing();
      const bool is_leaving = outgoing.is_leaving;
      send_outgoing(std::move(outgoing));
      if (is_leaving) break;
    }
    if ((items[1].revents & ZMQ_POLLIN) != 0) {
      drain(clock_);
      beat();
    }
  }
  say_goodbye();
}

void ClientThread::read_messages() {
  for (int i = 0; i < kMostReadAtOnce; ++i) {
    ZmqFrame frame;
    if (!socket_.receive(frame, ZMQ_DONTWAIT)) return;
    if (frame.has_more()) {
      socket_.drop_rest(frame);
      session_.refuse();
      continue;
    }
    auto message = decode_server_message(frame.bytes());
    if (!message) {
      session_.refuse();
      mailbox_.put_refusal(message.error().text());
    } else if (session_.take(std::move(*message), steady_s())) {
      beat_.heard();
    }
  }
}

void ClientThread::beat() {
  const double now_s = steady_s();
  mailbox_.put_beat();
  if (const auto failure = handshakes_.take()) mailbox_.put_refusal(*failure);
  if (!socket_.is_open() && !open_socket()) return;
  const BeatAction action = beat_.next(session_.is_welcomed(), now_s);
  if (action == BeatAction::kHello) send_hello(now_s);
  if (action == BeatAction::kHeartbeat) {
    // An age of 0 would mean that there is no window.
    const double age_s =
        options_.has_window ? now_s - realtime::seconds(frame_drawn_ns_.load(std::memory_order_relaxed)) : 0.0;
    send(Heartbeat{now_s, std::max(0.0, age_s), session_.ticks_received()});
  }
  if (action != BeatAction::kReconnect) return;
  // A new connection, so that it contains no old messages.
  session_.lose();
  if (const Status opened = open_socket(); !opened) log_warning("{}", opened.error().text());
}

void ClientThread::send_hello(double now_s) {
  const ClientMessage hello{0, 0, Hello{options_.name, options_.wants_control}};
  if (socket_.send(encode(hello), ZMQ_DONTWAIT)) beat_.said_hello(now_s);
}

void ClientThread::send_outgoing(Outgoing outgoing) {
  send_stops();
  for (Command& command : outgoing.commands) {
    const std::uint32_t request = command.request;
    if (session_.is_welcomed() && is_stop(command)) {
      stops_.push_back(request);
      send_stops();
    } else if (!session_.is_welcomed()) {
      mailbox_.put_reply({request, false, "no server connected"});
    } else if (!stops_.empty() || !send(std::move(command))) {
      mailbox_.put_reply({request, false, "the command is too large, or the server does not accept messages"});
    } else {
      session_.expect_reply(request);
    }
  }
  if (outgoing.hand && session_.is_welcomed()) send(*outgoing.hand);
}

void ClientThread::send_stops() {
  if (!session_.is_welcomed()) {
    for (const std::uint32_t request : std::exchange(stops_, {}))
      mailbox_.put_reply({request, false, "the server disconnected before it accepted the stop"});
  }
  while (!stops_.empty() && send(Command{stops_.front(), ServerCommand::kStop})) {
    session_.expect_reply(stops_.front());
    stops_.erase(stops_.begin());
  }
}

bool ClientThread::send(ClientBody body) {
  const Bytes bytes = encode(session_.message(std::move(body)));
  return bytes.size() <= kMostMessageBytes && socket_.send(bytes, ZMQ_DONTWAIT);
}

void ClientThread::say_goodbye() {
  if (session_.is_welcomed() && send(Goodbye{})) socket_.set(ZMQ_LINGER, kGoodbye_ms);
  socket_.close();
}

}  // namespace trocar::link::detail
