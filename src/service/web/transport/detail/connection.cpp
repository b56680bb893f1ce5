#include "web/transport/detail/connection.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "core/log.h"
#include "core/start_thread.h"

namespace trocar::web::detail {
namespace {

constexpr std::size_t kInputBytes = std::size_t{8} << 10;
constexpr std::size_t kMostCollected = std::size_t{64} << 10;
constexpr std::chrono::milliseconds kLinger{500};             ///< For a client that still sends.
constexpr std::size_t kMostLingering = std::size_t{1} << 20;  ///< Bytes of such a client.

short events_of(int ssl_error) {
  return ssl_error == SSL_ERROR_WANT_WRITE ? POLLOUT : POLLIN;
}

bool is_waiting(int ssl_error) {
  return ssl_error == SSL_ERROR_WANT_READ || ssl_error == SSL_ERROR_WANT_WRITE;
}

void read_address(int (*get_name)(int, sockaddr*, socklen_t*), int socket, std::string& ip, int& port) {
  sockaddr_storage storage{};
  socklen_t size = sizeof(storage);
  if (get_name(socket, reinterpret_cast<sockaddr*>(&storage), &size) != 0) return;
  char text[INET6_ADDRSTRLEN] = "";
  if (storage.ss_family == AF_INET) {
    const auto& v4 = reinterpret_cast<const sockaddr_in&>(storage);
    ::inet_ntop(AF_INET, &v4.sin_addr, text, sizeof(text));
    port = ntohs(v4.sin_port);
  } else if (storage.ss_family == AF_INET6) {
    const auto& v6 = reinterpret_cast<const sockaddr_in6&>(storage);
    ::inet_ntop(AF_INET6, &v6.sin6_addr, text, sizeof(text));
    port = ntohs(v6.sin6_port);
  }
  ip = text;
}

}  // namespace

Connection::Connection(int socket, SSL_CTX* tls, const ConnectionLimits& limits)
    : socket_(socket), ssl_(tls == nullptr ? nullptr : SSL_new(tls), SSL_free), limits_(limits), input_(kInputBytes) {
  if (ssl_) SSL_set_fd(ssl_.get(), socket_);
}

Connection::~Connection() {
  ssl_.reset();
  ::close(socket_);
}

bool Connection::wait(short events, Clock::time_point until) {
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    if (left <= 0) return false;
    pollfd descriptor{socket_, events, 0};
    const int ready = ::poll(&descriptor, 1, static_cast<int>(left));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
}

bool Connection::shake_hands() {
  if (!ssl_) return true;
  const auto until = Clock::now() + limits_.header_time;
  while (true) {
    ERR_clear_error();
    const int done = SSL_accept(ssl_.get());
    if (done == 1) return true;
    const int error = SSL_get_error(ssl_.get(), done);
    if (!is_waiting(error) || !wait(events_of(error), until)) return false;
  }
}

bool Connection::has_request(std::chrono::milliseconds time) {
  if (begin_ < end_ || (ssl_ && SSL_pending(ssl_.get()) > 0)) return true;
  const ssize_t count = receive(input_.data(), input_.size(), Clock::now() + time);
  begin_ = 0;
  end_ = count > 0 ? static_cast<std::size_t>(count) : 0;
  return count > 0;
}

void Connection::begin_header() {
  budget_ = limits_.header_bytes;
  is_in_body_ = false;
  deadline_ = Clock::now() + limits_.header_time;
}

void Connection::begin_body(std::size_t bytes) {
  budget_ = bytes;
  is_in_body_ = true;
  deadline_ = Clock::now() + limits_.body_time;
}

/// At least one byte; 0 if the client has closed, -1 on an error or after the deadline.
ssize_t Connection::receive(char* bytes, std::size_t size, Clock::time_point until) {
  while (true) {
    short events = POLLIN;
    if (ssl_) {
      ERR_clear_error();
      const int count = SSL_read(ssl_.get(), bytes, static_cast<int>(size));
      if (count > 0) return count;
      const int error = SSL_get_error(ssl_.get(), count);
      if (!is_waiting(error)) {
        is_ended_ = true;
        return error == SSL_ERROR_ZERO_RETURN ? 0 : -1;
      }
      events = events_of(error);
    } else {
      const ssize_t count = ::recv(socket_, bytes, size, MSG_DONTWAIT);
      if (count > 0) return count;
      if (count == 0 || (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)) {
        is_ended_ = true;
        return count == 0 ? 0 : -1;
      }
    }
    if (!wait(events, until)) return -1;
  }
}

ssize_t Connection::read(char* bytes, size_t size) {
  if (budget_ == 0) return -1;
  if (begin_ == end_) {
    const ssize_t count = receive(input_.data(), input_.size(), deadline_);
    if (count <= 0) return count;
    begin_ = 0;
    end_ = static_cast<std::size_t>(count);
  }
  const std::size_t taken = std::min({size, end_ - begin_, budget_});
  std::copy_n(input_.data() + begin_, taken, bytes);
  begin_ += taken;
  budget_ -= taken;
  return static_cast<ssize_t>(taken);
}

bool Connection::send_all(const char* bytes, std::size_t size) {
  const auto until = Clock::now() + limits_.write_time;
  while (size > 0) {
    ssize_t count = 0;
    short events = POLLOUT;
    if (ssl_) {
      ERR_clear_error();
      const int piece = static_cast<int>(std::min(size, kMostCollected));
      count = SSL_write(ssl_.get(), bytes, piece);
      const int error = count > 0 ? SSL_ERROR_NONE : SSL_get_error(ssl_.get(), static_cast<int>(count));
      if (count <= 0 && !is_waiting(error)) return false;
      events = events_of(error);
    } else {
      count = ::send(socket_, bytes, size, MSG_DONTWAIT | MSG_NOSIGNAL);
      if (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) return false;
    }
    if (count > 0) {
      bytes += count;
      size -= static_cast<std::size_t>(count);
    } else if (!wait(events, until)) {
      return false;
    }
  }
  return true;
}

ssize_t Connection::write(const char* bytes, size_t size) {
  if (output_.size() + size > kMostCollected) {
    if (!flush() || !send_all(bytes, size)) return -1;
  } else {
    output_.append(bytes, size);
  }
  return static_cast<ssize_t>(size);
}

bool Connection::flush() {
  const bool is_sent = send_all(output_.data(), output_.size());
  output_.clear();
  return is_sent;
}

void Connection::cut() {
  const linger at_once{1, 0};  // the destructor sends a reset
  ::setsockopt(socket_, SOL_SOCKET, SO_LINGER, &at_once, sizeof(at_once));
}

void Connection::close_gently() {
  if (ssl_ && !is_ended_) SSL_shutdown(ssl_.get());
  ::shutdown(socket_, SHUT_WR);
  const auto until = Clock::now() + kLinger;
  std::size_t drained = 0;
  while (drained < kMostLingering && wait(POLLIN, until)) {
    const ssize_t count = ::recv(socket_, input_.data(), input_.size(), MSG_DONTWAIT);
    if (count <= 0) break;
    drained += static_cast<std::size_t>(count);
  }
}

void Connection::get_remote_ip_and_port(std::string& ip, int& port) const {
  read_address(::getpeername, socket_, ip, port);
}

void Connection::get_local_ip_and_port(std::string& ip, int& port) const {
  read_address(::getsockname, socket_, ip, port);
}

WorkerThreads::Taken WorkerThreads::enqueue(std::function<void()> job) {
  std::unique_lock lock(mutex_);
  if (jobs_.size() >= free_ && threads_.size() < most_threads_) add_thread();
  if (threads_.empty()) {
    lock.unlock();
    job();
    return static_cast<Taken>(true);
  }
  jobs_.push_back(std::move(job));
  count_waiting();
  has_job_.notify_one();
  return static_cast<Taken>(true);
}

void WorkerThreads::add_thread() {
  auto thread = start_thread("connection", [this] { work(); });
  if (!thread) return log_warning("{}", thread.error().text());
  ++free_;
  threads_.push_back(*std::move(thread));
}

void WorkerThreads::shutdown() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  has_job_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void WorkerThreads::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    has_job_.wait(lock, [this] { return !jobs_.empty() || is_ending_; });
    if (jobs_.empty()) return;
    const std::function<void()> job = std::move(jobs_.front());
    jobs_.pop_front();
    --free_;
    count_waiting();
    lock.unlock();
    job();
    lock.lock();
    ++free_;
    count_waiting();
  }
}

void WorkerThreads::count_waiting() {
  waiting_ = static_cast<int>(jobs_.size() - std::min(jobs_.size(), free_));
}

}  // namespace trocar::web::detail
