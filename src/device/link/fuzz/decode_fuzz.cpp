// Fuzz target of scripts/fuzz: for any bytes, a decoder returns an error or a valid message.
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/result.h"
#include "link/codec.h"
#include "link/test/fingerprint.h"
#include "link/test/invariants.h"

namespace trocar::link {
namespace {

/// An accepted message is unchanged by encoding and decoding.
template <class Message, class Decode>
void check(std::span<const std::byte> bytes, Decode decode) {
  const Result<Message> decoded = decode(bytes);
  if (!decoded) {
    TROCAR_CHECK(!decoded.error().text().empty());
    return;
  }
  TROCAR_CHECK(find_broken_invariant(*decoded).empty());
  const Bytes encoded = encode(*decoded);
  if (encoded.size() > kMostMessageBytes) return;  // parts of a message may overlap
  const Result<Message> again = decode(encoded);
  TROCAR_CHECK(again.has_value());
  TROCAR_CHECK(Fingerprint(*again) == Fingerprint(*decoded));
}

}  // namespace
}  // namespace trocar::link

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  trocar::link::check<trocar::link::ClientMessage>(bytes, trocar::link::decode_client_message);
  trocar::link::check<trocar::link::ServerMessage>(bytes, trocar::link::decode_server_message);
  return 0;
}
