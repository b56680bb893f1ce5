#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "link/endpoint.h"

namespace trocar::link::detail {

inline constexpr std::size_t kCurveKeyBytes = 32;
using CurveKey = std::array<std::uint8_t, kCurveKeyBytes>;

/// The long-term keys of a server and the public keys of the clients that may connect.
class CurveIdentity {
 public:
  /// Errors (exit status 2): keys that are not CURVE keys in Z85.
  static Result<CurveIdentity> make(const CurveKeys& keys, const std::set<std::string>& allowed);

  const CurveKey& public_key() const { return public_key_; }
  const CurveKey& secret_key() const { return secret_key_; }
  bool allows(const CurveKey& client) const { return allowed_.contains(client); }

 private:
  CurveKey public_key_{}, secret_key_{};
  std::set<CurveKey> allowed_;
};

/// The server's side of CurveZMQ (ZeroMQ RFC 26) for one connection: HELLO, WELCOME, INITIATE, READY, then MESSAGE
/// boxes. Cryptography by libsodium. Input may be untrusted: each step either succeeds or returns an error.
class CurveHandshake {
 public:
  explicit CurveHandshake(const CurveIdentity& identity) : identity_(identity) {}

  /// The bytes between two steps: the answer to a command, and the client's metadata after INITIATE.
  struct Answer {
    std::vector<std::byte> command;
    std::vector<std::byte> metadata;
  };
  /// Answers HELLO or INITIATE. Errors: another command, a command for another server key, a client key that is not
  /// allowed.
  Result<Answer> answer(std::span<const std::byte> command);
  bool is_done() const { return step_ == Step::kDone; }
  /// The READY command after a valid INITIATE, with the server's metadata.
  std::vector<std::byte> ready(std::span<const std::byte> metadata);
  const CurveKey& client_key() const { return client_key_; }

  /// Content of a MESSAGE body: flags and payload. Errors of open(): the handshake is not done, or the message is
  /// damaged or replayed.
  struct Opened {
    std::uint8_t flags = 0;  ///< bit 0: more frames follow, bit 1: a command.
    std::vector<std::byte> payload;
  };
  Result<Opened> open(std::span<const std::byte> message);
  std::vector<std::byte> seal(std::uint8_t flags, std::span<const std::byte> payload);

 private:
  enum class Step { kHello, kInitiate, kDone };
  Result<Answer> answer_hello(std::span<const std::byte> command);
  Result<Answer> answer_initiate(std::span<const std::byte> command);
  bool is_fresh(std::span<const std::byte> nonce);

  const CurveIdentity& identity_;
  Step step_ = Step::kHello;
  CurveKey client_short_{};                   ///< C', the client's short-term key of this connection.
  CurveKey short_public_{}, short_secret_{};  ///< S' and s'
  CurveKey cookie_key_{};
  CurveKey session_key_{};  ///< Precomputed from C' and s'.
  CurveKey client_key_{};   ///< C
  std::uint64_t last_received_ = 0, last_sent_ = 0;
};

}  // namespace trocar::link::detail
