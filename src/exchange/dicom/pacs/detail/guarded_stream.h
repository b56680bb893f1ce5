#pragma once

// As Debian's library is compiled: the option changes the layout of its classes.
#define CPPHTTPLIB_OPENSSL_SUPPORT
#include <httplib.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace trocar::dicom::detail {

/// The reason for which a stream ended the transfer.
enum class StreamTrouble { kNone, kStalled, kCancelled, kEndlessHeader, kNotTls, kUntrusted };

struct StreamLimits {
  std::string tls_host;  ///< Name on the server's certificate; empty: not encrypted.
  int timeout_s = 30;
  std::function<bool()> is_cancelled;  ///< May be empty.
};

/// The connection below cpp-httplib, in place of its own, which waits for as long as bytes come, and reads header lines
/// of any length into memory.
class GuardedStream final : public httplib::Stream {
 public:
  GuardedStream(socket_t socket, const StreamLimits& limits, StreamTrouble& trouble);

  /// With TLS: agrees on a key with the server and checks its certificate against those of the system. False:
  /// `trouble`.
  bool shake_hands();

  bool is_readable() const override { return true; }
  bool is_writable() const override { return true; }
  ssize_t read(char* bytes, size_t size) override;
  ssize_t write(const char* bytes, size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return socket_; }

 private:
  bool wait(short events);
  ssize_t fill();

  socket_t socket_;
  std::unique_ptr<SSL_CTX, void (*)(SSL_CTX*)> authorities_{nullptr, SSL_CTX_free};
  std::unique_ptr<SSL, void (*)(SSL*)> ssl_{nullptr, SSL_free};
  const StreamLimits& limits_;
  StreamTrouble& trouble_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  ///< Of the bytes in the buffer that were not read yet.
  std::size_t single_reads_ = 0;     ///< Reads of one byte in a row: the library reads lines byte by byte.
  std::size_t line_bytes_ = 0;       ///< Of these, since the last end of a line.
};

/// The library's client on a GuardedStream. TLS is ours: the library's own client for it cannot be derived from in
/// newer versions. So the library takes the connection for a plain one, and the request has to name the host.
class GuardedClient final : public httplib::ClientImpl {
 public:
  GuardedClient(const std::string& host, int port, StreamLimits limits)
      : ClientImpl(host, port), limits_(std::move(limits)) {}
  StreamTrouble trouble() const noexcept { return trouble_; }

 private:
  bool process_socket(const Socket& socket, std::function<bool(httplib::Stream& stream)> callback) override {
    GuardedStream stream(socket.sock, limits_, trouble_);
    return stream.shake_hands() && callback(stream);
  }

  StreamLimits limits_;
  StreamTrouble trouble_ = StreamTrouble::kNone;
};

}  // namespace trocar::dicom::detail
