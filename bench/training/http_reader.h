#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace trocar::bench {

/// A reader of a server on this machine. Its connection is kept alive and opened anew where the server has closed it,
/// as it does after a number of requests. Errors are empty answers.
class HttpReader {
 public:
  explicit HttpReader(int port) : port_(port) {}
  ~HttpReader();
  HttpReader(const HttpReader&) = delete;
  HttpReader& operator=(const HttpReader&) = delete;

  struct Answer {
    int status = 0;
    std::string header;
    std::string body;       ///< Empty: it came in chunks, which are only counted.
    std::size_t bytes = 0;  ///< Of the content; of chunks, with their sizes.
  };
  /// Sends a request with these header lines (each ends with CR LF) and reads its answer.
  std::optional<Answer> send(std::string_view method, std::string_view target, std::string_view headers,
                             std::string_view body = {});

 private:
  bool connect();
  std::optional<std::size_t> count_chunks(std::size_t begin);
  void close();
  bool read_more();
  std::optional<Answer> exchange(std::string_view request);

  int port_;
  int socket_ = -1;
  std::string received_;
};

}  // namespace trocar::bench
