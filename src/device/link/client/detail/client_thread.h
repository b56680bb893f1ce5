#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/result.h"
#include "link/client/detail/client_mailbox.h"
#include "link/client/detail/client_session.h"
#include "link/client/detail/zmq_handles.h"
#include "link/client/haptic_client.h"

namespace trocar::link::detail {

/// The thread of a HapticClient: owns the socket, sends heartbeats at absolute times, sends Hello, and sends it again
/// after a timeout. It sleeps until its clock, its socket or wake() wakes it.
class ClientThread {
 public:
  static Result<std::unique_ptr<ClientThread>> start(const ClientOptions& options);
  ~ClientThread();  ///< Sends Goodbye and joins the thread.
  ClientThread(const ClientThread&) = delete;
  ClientThread& operator=(const ClientThread&) = delete;

  ClientMailbox& mailbox() { return mailbox_; }
  const ClientOptions& options() const { return options_; }
  /// Call it after the mailbox got a request.
  void wake() noexcept;
  void frame_drawn() noexcept;

 private:
  explicit ClientThread(const ClientOptions& options);
  Status open();
  Status open_socket();
  void run();
  void read_messages();
  void beat();
  void send_hello(double now_s);
  void send_outgoing(Outgoing outgoing);
  /// Sends the stops that the socket did not accept before; they end without a session.
  void send_stops();
  bool send(ClientBody body);
  void say_goodbye();

  const ClientOptions options_;
  ClientMailbox mailbox_;
  std::atomic<std::int64_t> frame_drawn_ns_;
  int wake_ = -1;   ///< eventfd
  int clock_ = -1;  ///< timerfd
  ZmqContext context_;

  // Used only by the thread.
  std::string routing_id_;  ///< Kept for later connections, so that the server identifies this client.
  ZmqSocket socket_;
  HandshakeMonitor handshakes_;
  ClientSession session_{mailbox_};
  ClientBeat beat_;
  std::vector<std::uint32_t> stops_;  ///< Requests of stops that are still to be sent, before all other commands.

  std::thread thread_;
};

}  // namespace trocar::link::detail
