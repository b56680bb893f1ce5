// Fuzz target of scripts/fuzz: for any bytes of a peer and any fragmentation, a connection stays within its limits and
// returns complete messages, or ends with a reason.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "core/result.h"
#include "link/endpoint.h"
#include "link/messages.h"
#include "link/zmtp/detail/zmtp_connection.h"

namespace trocar::link::detail {
namespace {

/// Bits of an input's first byte: state of the connection before the remaining bytes.
constexpr unsigned kWithKeys = 1, kAfterGreeting = 2, kAfterReady = 4, kAfterHello = 8;

const CurveIdentity& server_identity() {
  static const CurveIdentity identity = [] {
    const auto server = make_curve_keys();
    const auto client = make_curve_keys();
    TROCAR_CHECK(server && client);
    auto made = CurveIdentity::make(*server, {client->public_key});
    TROCAR_CHECK(made.has_value());
    return *made;
  }();
  return identity;
}

/// Data that a correct peer would have sent up to this state.
std::vector<std::byte> opening(unsigned how) {
  if ((how & (kAfterGreeting | kAfterReady)) == 0) return {};
  std::vector<std::byte> bytes = zmtp::make_greeting((how & kWithKeys) != 0 ? "CURVE" : "NULL", false);
  if ((how & kAfterReady) == 0 || (how & kWithKeys) != 0) return bytes;
  std::vector<std::byte> ready;
  append_bytes(ready, std::as_bytes(std::span(std::string_view("\x05READY"))));
  append_bytes(ready, zmtp::make_metadata("DEALER"));
  zmtp::append_frame(bytes, zmtp::kCommand, ready);
  return bytes;
}

/// Feeds a fragment and takes all resulting messages. Returns false if the connection has ended.
bool feed(ZmtpConnection& connection, std::span<const std::byte> piece, double now_s) {
  if (connection.room(now_s) == 0) return true;
  connection.append(piece);
  for (;;) {
    const ZmtpConnection::Incoming incoming = connection.next(now_s);
    TROCAR_CHECK(incoming.message.size() <= 2 * kMostMessageBytes);
    TROCAR_CHECK(connection.outgoing().size() <= kMostBytesOut + 4096);
    TROCAR_CHECK(connection.identity().size() <= 4096);
    if (incoming.event == ZmtpConnection::Event::kBroken) {
      TROCAR_CHECK(!connection.why().empty());
      return false;
    }
    if (incoming.event == ZmtpConnection::Event::kNone) return true;
    if (incoming.event != ZmtpConnection::Event::kMessage) continue;
    TROCAR_CHECK(connection.is_ready());
    connection.put(incoming.message);  // an echo of the received size
    connection.note_sent(connection.outgoing().size());
  }
}

void run(std::span<const std::byte> input) {
  if (input.empty()) return;
  const auto how = std::to_integer<unsigned>(input[0]);
  ZmtpConnection connection((how & kWithKeys) != 0 ? &server_identity() : nullptr);
  connection.set_greeted((how & kAfterHello) != 0);
  double now_s = 0.0;
  if (!feed(connection, opening(how), now_s)) return;
  std::span<const std::byte> rest = input.subspan(1);
  while (!rest.empty()) {
    const std::size_t wanted = 1 + std::to_integer<std::size_t>(rest[0]);
    rest = rest.subspan(1);
    const std::size_t size = std::min(wanted, rest.size());
    if (!feed(connection, rest.first(size), now_s)) return;
    rest = rest.subspan(size);
    now_s += 1e-3;
  }
}

}  // namespace
}  // namespace trocar::link::detail

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  trocar::link::detail::run(std::as_bytes(std::span(data, size)));
  return 0;
}
