#include "link/zmtp/detail/curve_handshake.h"

#include <fmt/format.h>
#include <sodium.h>
#include <zmq.h>

#include <algorithm>
#include <cstring>
#include <string_view>

#include "link/zmtp/detail/zmtp_frames.h"

namespace trocar::link::detail {
namespace {

constexpr std::size_t kKeyTextBytes = 40;
constexpr std::size_t kShortNonce = 8, kLongNonce = 16, kMac = crypto_box_MACBYTES;

// Layout of the commands, in bytes from their start (RFC 26).
constexpr std::string_view kHello = "\x05HELLO", kWelcome = "\x07WELCOME", kInitiate = "\x08INITIATE";
constexpr std::string_view kReady = "\x05READY", kMessage = "\x07MESSAGE";
constexpr std::size_t kHelloBytes = 200, kHelloKey = 80, kHelloNonce = 112, kHelloBox = 120, kHelloZeros = 64;
constexpr std::size_t kCookieBytes = kLongNonce + kMac + 2 * kCurveKeyBytes;
constexpr std::size_t kInitiateCookie = 9, kInitiateNonce = kInitiateCookie + kCookieBytes;
constexpr std::size_t kInitiateBox = kInitiateNonce + kShortNonce;
constexpr std::size_t kVouchNonce = kCurveKeyBytes, kVouchBox = kVouchNonce + kLongNonce;
constexpr std::size_t kMetadata = kVouchBox + kMac + 2 * kCurveKeyBytes;
constexpr std::size_t kMessageNonce = 8, kMessageBox = kMessageNonce + kShortNonce;

using Nonce = std::array<std::uint8_t, crypto_box_NONCEBYTES>;
using ByteVector = std::vector<std::byte>;
using ByteSpan = std::span<const std::byte>;

const std::uint8_t* raw(ByteSpan bytes) {
  return reinterpret_cast<const std::uint8_t*>(bytes.data());
}
std::uint8_t* raw(ByteVector& bytes) {
  return reinterpret_cast<std::uint8_t*>(bytes.data());
}

/// 24 bytes: a prefix that names the step, then bytes that are never repeated.
Nonce make_nonce(std::string_view prefix, ByteSpan rest) {
  Nonce nonce{};
  std::memcpy(nonce.data(), prefix.data(), prefix.size());
  std::memcpy(nonce.data() + prefix.size(), rest.data(), std::min(rest.size(), nonce.size() - prefix.size()));
  return nonce;
}

ByteVector begin_command(std::string_view name) {
  ByteVector command;
  append_bytes(command, std::as_bytes(std::span(name)));
  return command;
}
bool is_command(ByteSpan bytes, std::string_view name) {
  return bytes.size() >= name.size() && std::memcmp(bytes.data(), name.data(), name.size()) == 0;
}

CurveKey key_at(ByteSpan bytes, std::size_t offset) {
  CurveKey key;
  std::memcpy(key.data(), bytes.data() + offset, key.size());
  return key;
}

std::array<std::byte, kShortNonce> counter_bytes(std::uint64_t counter) {
  std::array<std::byte, kShortNonce> bytes;
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(counter >> (56 - 8 * i));
  return bytes;
}
std::uint64_t counter_of(ByteSpan bytes) {
  std::uint64_t counter = 0;
  for (std::size_t i = 0; i < kShortNonce; ++i) counter = (counter << 8) | std::to_integer<std::uint64_t>(bytes[i]);
  return counter;
}
std::array<std::byte, kLongNonce> random_nonce() {
  std::array<std::byte, kLongNonce> nonce;
  randombytes_buf(nonce.data(), nonce.size());
  return nonce;
}

ByteVector seal_for(const CurveKey& to, const CurveKey& from_secret, const Nonce& nonce, ByteSpan plain) {
  ByteVector box(plain.size() + kMac);
  if (crypto_box_easy(raw(box), raw(plain), plain.size(), nonce.data(), to.data(), from_secret.data()) != 0) return {};
  return box;
}
/// Returns false for damaged data or another key.
bool open_from(const CurveKey& from, const CurveKey& to_secret, const Nonce& nonce, ByteSpan box, ByteVector& plain) {
  if (box.size() < kMac) return false;
  plain.resize(box.size() - kMac);
  return crypto_box_open_easy(raw(plain), raw(box), box.size(), nonce.data(), from.data(), to_secret.data()) == 0;
}

bool decode_key(const std::string& text, CurveKey& key) {
  return text.size() == kKeyTextBytes && zmq_z85_decode(key.data(), text.c_str()) != nullptr;
}

tl::unexpected<Error> damaged(const char* command) {
  return fail(fmt::format("a damaged {} of CURVE", command), "link", "check the program on the other side");
}

}  // namespace

Result<CurveIdentity> CurveIdentity::make(const CurveKeys& keys, const std::set<std::string>& allowed) {
  if (sodium_init() < 0) return fail("cryptography cannot be used", "libsodium", "reinstall libsodium");
  CurveIdentity identity;
  const bool are_keys =
      decode_key(keys.public_key, identity.public_key_) && decode_key(keys.secret_key, identity.secret_key_);
  if (!are_keys) return fail_usage("the server's keys are not CURVE keys", {}, "make new ones: trocar link keygen");
  for (const std::string& text : allowed) {
    CurveKey key;
    if (!decode_key(text, key))
      return fail_usage("an allowed client's key is not a CURVE key", text, "make keys with trocar link keygen");
    identity.allowed_.insert(key);
  }
  return identity;
}

Result<CurveHandshake::Answer> CurveHandshake::answer(std::span<const std::byte> command) {
  if (step_ == Step::kHello && is_command(command, kHello)) return answer_hello(command);
  if (step_ == Step::kInitiate && is_command(command, kInitiate)) return answer_initiate(command);
  return fail("an unexpected command during the CURVE handshake", "link", "check the program on the other side");
}

Result<CurveHandshake::Answer> CurveHandshake::answer_hello(std::span<const std::byte> command) {
  if (command.size() != kHelloBytes) return damaged("HELLO");
  client_short_ = key_at(command, kHelloKey);
  const Nonce hello_nonce = make_nonce("CurveZMQHELLO---", command.subspan(kHelloNonce, kShortNonce));
  ByteVector zeros;
  if (!open_from(client_short_, identity_.secret_key(), hello_nonce, command.subspan(kHelloBox), zeros) ||
      zeros.size() != kHelloZeros) {
    return fail("a client has the public key of another server", "link",
                "give the client the server.pub file of this server");
  }
  is_fresh(command.subspan(kHelloNonce, kShortNonce));
  crypto_box_keypair(short_public_.data(), short_secret_.data());
  randombytes_buf(cookie_key_.data(), cookie_key_.size());

  // INITIATE returns the cookie and proves that it belongs to this HELLO.
  ByteVector keys;
  append_bytes(keys, std::as_bytes(std::span(client_short_)));
  append_bytes(keys, std::as_bytes(std::span(short_secret_)));
  const auto cookie_nonce = random_nonce();
  ByteVector cookie(keys.size() + kMac);
  crypto_secretbox_easy(raw(cookie), raw(keys), keys.size(), make_nonce("COOKIE--", cookie_nonce).data(),
                        cookie_key_.data());
  ByteVector plain;
  append_bytes(plain, std::as_bytes(std::span(short_public_)));
  append_bytes(plain, cookie_nonce);
  append_bytes(plain, cookie);

  const auto welcome_nonce = random_nonce();
  Answer answer{begin_command(kWelcome), {}};
  append_bytes(answer.command, welcome_nonce);
  append_bytes(answer.command,
               seal_for(client_short_, identity_.secret_key(), make_nonce("WELCOME-", welcome_nonce), plain));
  step_ = Step::kInitiate;
  return answer;
}

Result<CurveHandshake::Answer> CurveHandshake::answer_initiate(std::span<const std::byte> command) {
  if (command.size() < kInitiateBox + kMac + kMetadata) return damaged("INITIATE");
  const ByteSpan cookie = command.subspan(kInitiateCookie, kCookieBytes);
  ByteVector keys(2 * kCurveKeyBytes);
  const Nonce cookie_nonce = make_nonce("COOKIE--", cookie.first(kLongNonce));
  const ByteSpan cookie_box = cookie.subspan(kLongNonce);
  if (crypto_secretbox_open_easy(raw(keys), raw(cookie_box), cookie_box.size(), cookie_nonce.data(),
                                 cookie_key_.data()) != 0 ||
      key_at(keys, 0) != client_short_ || key_at(keys, kCurveKeyBytes) != short_secret_) {
    return damaged("INITIATE");
  }
  const ByteSpan nonce = command.subspan(kInitiateNonce, kShortNonce);
  ByteVector plain;
  if (!is_fresh(nonce) || !open_from(client_short_, short_secret_, make_nonce("CurveZMQINITIATE", nonce),
                                     command.subspan(kInitiateBox), plain)) {
    return damaged("INITIATE");
  }
  // The vouch proves that the owner of C made C' for this server.
  const ByteSpan opened(plain);
  client_key_ = key_at(opened, 0);
  const Nonce vouch_nonce = make_nonce("VOUCH---", opened.subspan(kVouchNonce, kLongNonce));
  ByteVector vouch;
  if (!open_from(client_key_, short_secret_, vouch_nonce, opened.subspan(kVouchBox, kMetadata - kVouchBox), vouch) ||
      key_at(vouch, 0) != client_short_ || key_at(vouch, kCurveKeyBytes) != identity_.public_key()) {
    return damaged("INITIATE");
  }
  if (!identity_.allows(client_key_)) {
    std::array<char, kKeyTextBytes + 1> text{};
    zmq_z85_encode(text.data(), client_key_.data(), client_key_.size());
    return fail(fmt::format("the client's key is not allowed: {}", text.data()), "link",
                "add its .pub key to the allow-list");
  }
  if (crypto_box_beforenm(session_key_.data(), client_short_.data(), short_secret_.data()) != 0) {
    return damaged("INITIATE");
  }
  step_ = Step::kDone;
  return Answer{{}, {opened.begin() + kMetadata, opened.end()}};
}

Result<CurveHandshake::Opened> CurveHandshake::open(std::span<const std::byte> message) {
  if (!is_done() || !is_command(message, kMessage) || message.size() < kMessageBox + kMac + 1) {
    return damaged("MESSAGE");
  }
  const ByteSpan nonce = message.subspan(kMessageNonce, kShortNonce), box = message.subspan(kMessageBox);
  ByteVector plain(box.size() - kMac);
  if (!is_fresh(nonce) ||
      crypto_box_open_easy_afternm(raw(plain), raw(box), box.size(), make_nonce("CurveZMQMESSAGEC", nonce).data(),
                                   session_key_.data()) != 0) {
    return damaged("MESSAGE");
  }
  const auto flags = std::to_integer<std::uint8_t>(plain.front());
  plain.erase(plain.begin());
  return Opened{flags, std::move(plain)};
}

std::vector<std::byte> CurveHandshake::seal(std::uint8_t flags, std::span<const std::byte> payload) {
  ByteVector plain;
  plain.reserve(payload.size() + 1);
  plain.push_back(std::byte{flags});
  append_bytes(plain, payload);
  const auto nonce = counter_bytes(++last_sent_);
  ByteVector message = begin_command(kMessage);
  append_bytes(message, nonce);
  const std::size_t box = message.size();
  message.resize(box + plain.size() + kMac);
  crypto_box_easy_afternm(raw(message) + box, raw(plain), plain.size(), make_nonce("CurveZMQMESSAGES", nonce).data(),
                          session_key_.data());
  return message;
}

/// The short nonces of a client only increase.
bool CurveHandshake::is_fresh(std::span<const std::byte> nonce) {
  const std::uint64_t counter = counter_of(nonce);
  if (counter <= last_received_) return false;
  last_received_ = counter;
  return true;
}

std::vector<std::byte> CurveHandshake::ready(std::span<const std::byte> metadata) {
  const auto nonce = counter_bytes(++last_sent_);
  ByteVector command = begin_command(kReady);
  append_bytes(command, nonce);
  const std::size_t box = command.size();
  command.resize(box + metadata.size() + kMac);
  crypto_box_easy_afternm(raw(command) + box, raw(metadata), metadata.size(),
                          make_nonce("CurveZMQREADY---", nonce).data(), session_key_.data());
  return command;
}

}  // namespace trocar::link::detail
