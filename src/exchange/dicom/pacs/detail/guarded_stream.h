#pragma once

// As Debian's library is compiled: the option changes the layout of its classes.
#define CPPHTTPLIB_OPENSSL_SUPPORT
#include <httplib.h>

#include <functional>
#include <string>
#include <vector>

namespace trocar::dicom::detail {

/// The reason for which a stream ended the transfer.
enum class StreamTrouble { kNone, kStalled, kCancelled, kEndlessHeader };

struct StreamLimits {
  int timeout_s = 30;
  std::function<bool()> is_cancelled;  ///< May be empty.
};

/// The connection below cpp-httplib, in place of its own, which waits for as long as bytes come, and reads header lines
/// of any length into memory.
class GuardedStream final : public httplib::Stream {
 public:
  /// `ssl` null: not encrypted.
  GuardedStream(socket_t socket, SSL* ssl, const StreamLimits& limits, StreamTrouble& trouble);

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
  SSL* ssl_;
  const StreamLimits& limits_;
  StreamTrouble& trouble_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  ///< Of the bytes in the buffer that were not read yet.
  std::size_t single_reads_ = 0;     ///< Reads of one byte in a row: the library reads lines byte by byte.
};

/// One of the library's clients, on a GuardedStream.
template <class Client>
class GuardedClient final : public Client {
 public:
  GuardedClient(const std::string& host, int port, StreamLimits limits)
      : Client(host, port), limits_(std::move(limits)) {}
  StreamTrouble trouble() const noexcept { return trouble_; }

 private:
  bool process_socket(const typename Client::Socket& socket,
                      std::function<bool(httplib::Stream& stream)> callback) override {
    GuardedStream stream(socket.sock, socket.ssl, limits_, trouble_);
    return callback(stream);
  }

  StreamLimits limits_;
  StreamTrouble trouble_ = StreamTrouble::kNone;
};

}  // namespace trocar::dicom::detail
