#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/result.h"
#include "link/messages.h"

namespace trocar::link {

using Bytes = std::vector<std::byte>;

/// Any struct of messages.h as bytes. A batch of more than kMostSamples is the caller's mistake. What the decoder would
/// refuse (a text with control characters or too long, NaN in a pose) is encoded all the same, and refused there.
Bytes encode(const ClientMessage& message);
Bytes encode(const ServerMessage& message);

/// Hostile bytes welcome: truncated, oversized, of another version, with NaN poses, rotations that are none, texts too
/// long or not UTF-8, enumerators out of range: an Error that says which. Never allocates more than a small multiple of
/// the bytes. Of a tick the time, tip, axis and device position must be finite; its forces and the rest arrive bit for
/// bit, NaN too, for the record of a fault must show it.
Result<ClientMessage> decode_client_message(std::span<const std::byte> bytes);
/// Of a command whose numbers or texts were refused though its frame is sound: what a reply needs.
struct CommandNumber {
  std::uint64_t session = 0, sequence = 0;
  std::uint32_t request = 0;
};
std::optional<CommandNumber> find_command(std::span<const std::byte> bytes);
Result<ServerMessage> decode_server_message(std::span<const std::byte> bytes);

}  // namespace trocar::link
