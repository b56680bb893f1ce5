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

/// Encodes any struct of messages.h. The caller must not pass a batch of more than kMostSamples. Values that the
/// decoder refuses (a text with control characters or too long, NaN in a pose) are encoded without a check.
Bytes encode(const ClientMessage& message);
Bytes encode(const ServerMessage& message);

/// Decodes untrusted bytes. Messages that are truncated, oversized or of another version, NaN poses, invalid rotations,
/// texts that are too long or not UTF-8, and enumerators out of range give an Error that names the problem. Never
/// allocates more than a small multiple of the input. Time, tip, axis and device position of a tick must be finite;
/// other values are kept bit by bit, including NaN, for records of faults.
Result<ClientMessage> decode_client_message(std::span<const std::byte> bytes);
/// Session, sequence and request of a command in a valid frame whose numbers or texts were refused; for the reply.
struct CommandNumber {
  std::uint64_t session = 0, sequence = 0;
  std::uint32_t request = 0;
};
std::optional<CommandNumber> find_command(std::span<const std::byte> bytes);
Result<ServerMessage> decode_server_message(std::span<const std::byte> bytes);

}  // namespace trocar::link
