#include "dicom/pacs/detail/guarded_stream.h"

#include <openssl/ssl.h>
#include <openssl/x509v3.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <chrono>
#include <cstring>

#include "dicom/pacs/pacs_source.h"

namespace trocar::dicom::detail {
namespace {

constexpr std::size_t kStreamBufferBytes = std::size_t{1} << 16;
constexpr std::size_t kMaxHttpHeader = std::size_t{1} << 16;
constexpr std::size_t kMaxHttpLine = std::size_t{1}
                                     << 14;  ///< Newer versions of the library end at 32 KiB, without a reason.

}  // namespace

GuardedStream::GuardedStream(socket_t socket, const StreamLimits& limits, StreamTrouble& trouble)
    : socket_(socket), limits_(limits), trouble_(trouble), buffer_(kStreamBufferBytes) {}

bool GuardedStream::shake_hands() {
  if (limits_.tls_host.empty()) return true;
  trouble_ = StreamTrouble::kNotTls;
  authorities_.reset(SSL_CTX_new(TLS_client_method()));
  if (!authorities_ || SSL_CTX_set_min_proto_version(authorities_.get(), TLS1_2_VERSION) != 1 ||
      SSL_CTX_set_default_verify_paths(authorities_.get()) != 1)
    return false;
  ssl_.reset(SSL_new(authorities_.get()));
  if (!ssl_ || SSL_set_fd(ssl_.get(), socket_) != 1) return false;
  SSL_set_verify(ssl_.get(), SSL_VERIFY_PEER, nullptr);
  const char* host = limits_.tls_host.c_str();
  const bool is_address = X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(ssl_.get()), host) == 1;
  if (!is_address && (SSL_set1_host(ssl_.get(), host) != 1 || SSL_set_tlsext_host_name(ssl_.get(), host) != 1))
    return false;
  while (true) {
    const int done = SSL_connect(ssl_.get());
    if (done == 1) break;
    const int error = SSL_get_error(ssl_.get(), done);
    if (error == SSL_ERROR_WANT_READ || error == SSL_ERROR_WANT_WRITE) {
      if (!wait(error == SSL_ERROR_WANT_READ ? POLLIN : POLLOUT)) return false;
      continue;
    }
    if (SSL_get_verify_result(ssl_.get()) != X509_V_OK) trouble_ = StreamTrouble::kUntrusted;
    return false;
  }
  trouble_ = StreamTrouble::kNone;
  return true;
}

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
    if ((!ssl_ || SSL_pending(ssl_.get()) == 0) && !wait(POLLIN)) return -1;
    if (!ssl_) return ::recv(socket_, buffer_.data(), buffer_.size(), 0);
    const int count = SSL_read(ssl_.get(), buffer_.data(), static_cast<int>(buffer_.size()));
    if (count > 0) return count;
    const int error = SSL_get_error(ssl_.get(), count);
    if (error == SSL_ERROR_ZERO_RETURN) return 0;
    if (error != SSL_ERROR_WANT_READ && error != SSL_ERROR_WANT_WRITE) return -1;
  }
}

ssize_t GuardedStream::read(char* bytes, size_t size) {
  if (trouble_ != StreamTrouble::kNone) return -1;
  single_reads_ = size == 1 ? single_reads_ + 1 : 0;
  if (single_reads_ > kMaxHttpHeader || line_bytes_ > kMaxHttpLine) {
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
  line_bytes_ = size != 1 || *bytes == '\n' ? 0 : line_bytes_ + 1;
  return static_cast<ssize_t>(part);
}

ssize_t GuardedStream::write(const char* bytes, size_t size) {
  if (!wait(POLLOUT)) return -1;
  if (!ssl_) return ::send(socket_, bytes, size, MSG_NOSIGNAL);
  return SSL_write(ssl_.get(), bytes, static_cast<int>(std::min(size, kStreamBufferBytes)));
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
