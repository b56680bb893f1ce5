#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "web/transport/detail/httplib_include.h"

namespace trocar::web::detail {

/// What a client may take of a connection before it is closed.
struct ConnectionLimits {
  std::size_t header_bytes = std::size_t{16} << 10;  ///< Request line and all header lines.
  std::chrono::milliseconds header_time{5000};       ///< From the first byte to the last header line.
  std::chrono::milliseconds body_time{10000};        ///< From the last header line to the end of the body.
  std::chrono::milliseconds write_time{20000};       ///< For one answer.
};

/// A connection below cpp-httplib, plain or TLS, in place of the library's own, which waits for as long as bytes come
/// and reads a header of any length into memory. Deadlines hold for whole messages, not for single bytes. Answers are
/// collected and sent by flush(). One thread at a time.
class Connection final : public httplib::Stream {
 public:
  /// Takes the socket, which the destructor closes. `tls` null: not encrypted.
  Connection(int socket, SSL_CTX* tls, const ConnectionLimits& limits);
  ~Connection() override;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// The handshake of TLS. False: it failed or took too long.
  bool shake_hands();
  /// Whether bytes of a request are there, after at most `time`.
  bool has_request(std::chrono::milliseconds time);
  bool is_closed_by_client() const noexcept { return is_ended_; }

  void begin_header();
  /// Allows a body of so many bytes, and no more.
  void begin_body(std::size_t bytes);
  bool flush();
  /// Whether the client sent bytes that no request has taken.
  bool has_unread_body() const noexcept { return is_in_body_ && budget_ > 0; }
  /// Makes the end of the connection an error for the client, whose answer is not whole.
  void cut();
  /// Ends the connection so that the client receives the last answer although it still sends.
  void close_gently();

  bool is_readable() const override { return true; }
  bool is_writable() const override { return true; }
  ssize_t read(char* bytes, size_t size) override;
  ssize_t write(const char* bytes, size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return socket_; }

 private:
  using Clock = std::chrono::steady_clock;
  bool wait(short events, Clock::time_point until);
  ssize_t receive(char* bytes, std::size_t size, Clock::time_point until);
  bool send_all(const char* bytes, std::size_t size);

  int socket_;
  std::unique_ptr<SSL, decltype(&SSL_free)> ssl_;
  ConnectionLimits limits_;
  Clock::time_point deadline_;
  std::size_t budget_ = 0;  ///< Bytes that the library may still read.
  bool is_in_body_ = false;
  bool is_ended_ = false;
  std::vector<char> input_;
  std::size_t begin_ = 0, end_ = 0;  ///< Of the bytes in `input_` that were not read yet.
  std::string output_;
};

/// Threads of a server, one a connection. A thread starts when all others are busy, up to a maximum; then connections
/// wait in a queue, and `waiting` counts them. If no thread can start, connections wait for those that run; without
/// one, the listening thread serves the connection itself.
class WorkerThreads final : public httplib::TaskQueue {
 public:
  WorkerThreads(std::size_t most_threads, std::atomic<int>& waiting) : most_threads_(most_threads), waiting_(waiting) {}

  /// void or bool, by the library's version. Every job is taken.
  using Taken = decltype(std::declval<httplib::TaskQueue&>().enqueue(std::function<void()>()));
  Taken enqueue(std::function<void()> job) override;
  /// Ends after all jobs, also those that wait.
  void shutdown() override;

 private:
  /// With the lock.
  void add_thread();
  void work();
  void count_waiting();

  const std::size_t most_threads_;
  std::atomic<int>& waiting_;
  std::mutex mutex_;
  std::condition_variable has_job_;
  std::list<std::function<void()>> jobs_;
  std::vector<std::thread> threads_;
  std::size_t free_ = 0;  ///< Threads without a job, also those that start.
  bool is_ending_ = false;
};

}  // namespace trocar::web::detail
