#include "bench/training/http_reader.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/text.h"

namespace trocar::bench {

HttpReader::~HttpReader() {
  close();
}

void HttpReader::close() {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

bool HttpReader::connect() {
  if (socket_ >= 0) return true;
  socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof(yes));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port_));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
}

bool HttpReader::read_more() {
  char buffer[65536];
  const ssize_t count = ::recv(socket_, buffer, sizeof(buffer), 0);
  if (count <= 0) return false;
  received_.append(buffer, static_cast<std::size_t>(count));
  return true;
}

std::optional<HttpReader::Answer> HttpReader::send(std::string_view method, std::string_view target,
                                                   std::string_view headers, std::string_view body) {
  const auto answer = exchange(fmt::format("{} {} HTTP/1.1\r\nHost: localhost\r\nContent-Length: {}\r\n{}\r\n{}",
                                           method, target, body.size(), headers, body));
  if (!answer || answer->header.find("\r\nConnection: close\r\n") != std::string::npos) close();
  return answer;
}

/// Reads chunks from this place on without keeping them.
std::optional<std::size_t> HttpReader::count_chunks(std::size_t begin) {
  constexpr std::string_view kEnd = "\r\n0\r\n\r\n";
  received_.erase(0, begin);
  std::size_t bytes = received_.size();
  while (!received_.ends_with(kEnd)) {
    if (received_.size() > kEnd.size()) received_.erase(0, received_.size() - kEnd.size());
    const std::size_t before = received_.size();
    if (!read_more()) return std::nullopt;
    bytes += received_.size() - before;
  }
  return bytes;
}

std::optional<HttpReader::Answer> HttpReader::exchange(std::string_view request) {
  if (!connect()) return std::nullopt;
  if (::send(socket_, request.data(), request.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(request.size()))
    return std::nullopt;
  received_.clear();
  std::size_t end = std::string::npos;
  while ((end = received_.find("\r\n\r\n")) == std::string::npos)
    if (!read_more()) return std::nullopt;
  Answer answer;
  answer.header = received_.substr(0, end + 2);
  constexpr std::size_t kStatusAt = 9, kStatusDigits = 3;
  if (answer.header.size() < kStatusAt + kStatusDigits) return std::nullopt;
  answer.status = parse_number<int>(std::string_view(answer.header).substr(kStatusAt, kStatusDigits)).value_or(0);
  if (answer.header.find("\r\nTransfer-Encoding: chunked\r\n") != std::string::npos) {
    const auto bytes = count_chunks(end + 4);
    if (!bytes) return std::nullopt;
    answer.bytes = *bytes;
    return answer;
  }
  constexpr std::string_view kLength = "\r\nContent-Length: ";
  const std::size_t at = answer.header.find(kLength);
  std::size_t length = 0;
  if (at != std::string::npos)
    if (const auto number =
            find_leading_number<std::size_t>(std::string_view(answer.header).substr(at + kLength.size())))
      length = number->value;
  const std::size_t begin = end + 4;
  while (received_.size() < begin + length)
    if (!read_more()) return std::nullopt;
  answer.body = received_.substr(begin, length);
  answer.bytes = length;
  return answer;
}

}  // namespace trocar::bench
