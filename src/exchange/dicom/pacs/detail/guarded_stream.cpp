#include "dicom/pacs/detail/guarded_stream.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <chrono>
#include <cstring>

namespace trocar::dicom::detail {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 16;
constexpr std::size_t kMaxHeader = std::size_t{1} << 16;
constexpr int kPoll_ms = 200;

}  // namespace

GuardedStream::GuardedStream(socket_t socket, SSL* ssl, const StreamLimits& limits, StreamTrouble& trouble)
    : socket_(socket), ssl_(ssl), limits_(limits), trouble_(trouble), buffer_(kBufferBytes) {}

bool GuardedStream::wait(short events) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(limits_.timeout_s);
  while (std::chrono::steady_clock::now() < until) {
    if (limits_.is_cancelled && limits_.is_cancelled()) {
      trouble_ = StreamTrouble::kCancelled;
      return false;
    }
    pollfd one{socket_, events, 0};
    if (::poll(&one, 1, kPoll_ms) > 0) return true;
  }
  trouble_ = StreamTrouble::kStalled;
  return false;
}

ssize_t GuardedStream::fill() {
  while (true) {
    if ((ssl_ == nullptr || SSL_pending(ssl_) == 0) && !wait(POLLIN)) return -1;
    if (ssl_ == nullptr) return ::recv(socket_, buffer_.data(), buffer_.size(), 0);
    const int count = SSL_read(ssl_, buffer_.data(), static_cast<int>(buffer_.size()));
    if (count > 0) return count;
    const int error = SSL_get_error(ssl_, count);
    if (error == SSL_ERROR_ZERO_RETURN) return 0;
    if (error != SSL_ERROR_WANT_READ && error != SSL_ERROR_WANT_WRITE) return -1;
  }
}

ssize_t GuardedStream::read(char* bytes, size_t size) {
  if (trouble_ != StreamTrouble::kNone) return -1;
  single_reads_ = size == 1 ? single_reads_ + 1 : 0;
  if (single_reads_ > kMaxHeader) {
    trouble_ = StreamTrouble::kEndlessHeader;
    return -1;
  }
  if (begin_ == end_) {
    const ssize_t count = fill();
    if (count <= 0) return count;
    begin_ = 0;
    end_ = static_cast<std::size_t>(count);
  }
  const std::size_t part = std::min(size, end_ - begin_);
  std::memcpy(bytes, buffer_.data() + begin_, part);
  begin_ += part;
  return static_cast<ssize_t>(part);
}

ssize_t GuardedStream::write(const char* bytes, size_t size) {
  if (!wait(POLLOUT)) return -1;
  if (ssl_ == nullptr) return ::send(socket_, bytes, size, MSG_NOSIGNAL);
  return SSL_write(ssl_, bytes, static_cast<int>(std::min(size, kBufferBytes)));
}

void GuardedStream::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip.clear();  // only servers ask
  port = 0;
}

void GuardedStream::get_local_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}

}  // namespace trocar::dicom::detail
