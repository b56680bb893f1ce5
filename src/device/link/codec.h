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

/// Decodes untrusted bytes: truncated, oversized, of another version, with NaN poses, invalid rotations, texts too long
/// or not UTF-8, enumerators out of range give an Error that names the problem. Never allocates more than a small
/// multiple of the input. Time, tip, axis and device position of a tick must be finite; other values are kept bit by
/// bit, including NaN, for records of faults.
Result<ClientMessage> decode_client_message(std::span<const std::byte> bytes);
/// Of a command whose numbers or texts were refused though its frame is sound: what a reply needs.
struct CommandNumber {
  std::uint64_t session = 0, sequence = 0;
  std::uint32_t request = 0;
};
std::optional<CommandNumber> find_command(std::span<const std::byte> bytes);
Result<ServerMessage> decode_server_message(std::span<const std::byte> bytes);

}  // namespace trocar::link
