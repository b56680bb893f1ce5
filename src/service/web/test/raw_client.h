#pragma once

#include <string>
#include <string_view>

namespace trocar::web::testing {

/// A connection to a server on 127.0.0.1 that sends exactly the bytes of a test.
class RawClient {
 public:
  explicit RawClient(int port);
  ~RawClient();
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  /// False: the server has closed the connection.
  bool send(std::string_view bytes);
  /// All bytes until the server closes the connection.
  std::string read_to_end();
  /// Bytes until `ending` has come, or the server closes the connection.
  std::string read_until(std::string_view ending);

 private:
  int socket_;
};

/// The answer of the server to these bytes, after which the client waits for the end of the connection.
std::string answer_to(int port, std::string_view bytes);
/// Status of an answer; 0: none.
int status_of(std::string_view answer);

}  // namespace trocar::web::testing
