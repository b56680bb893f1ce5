#pragma once

#include <cstddef>

/// Limits of a server for its clients. docs/link.md lists these numbers for other implementations.
namespace trocar::link {

inline constexpr std::size_t kMostMessageBytes = 1 << 20;  ///< Larger messages are dropped unread.
inline constexpr std::size_t kMostTextBytes = 256 * 1024;  ///< Limit of one string (a tissue table is the longest).
inline constexpr std::size_t kMostNameBytes = 256;         ///< Limit of a client's name in Hello.
inline constexpr std::size_t kMostBytesBeforeHello = 4096;
inline constexpr double kMostPressed_mm = 100.0;  ///< Of a placed needle: see HandTarget.

// Rate limits of one connection, before and after Hello. A peer above them is read more slowly. [assumed]
inline constexpr double kMostMessagesPerS = 4000.0;  ///< Above 1 kHz of hand targets plus heartbeats and commands.
inline constexpr double kMostMessagesAtOnce = 1000.0;
inline constexpr double kMostBytesPerS = 4.0 * 1024 * 1024;
inline constexpr double kMostBytesAtOnce = 4.0 * 1024 * 1024;
/// Limit of bytes queued for a client; further batches are dropped for it [assumed: two seconds at 1 kHz].
inline constexpr std::size_t kMostBytesOut = 1280 * 1024;
/// Additional queue for replies to commands, which are never dropped; a client with a full reply queue is removed.
inline constexpr std::size_t kMostReplyBytesOut = 1 << 20;

// Connections and clients. [assumed]
inline constexpr std::size_t kMostUnauthenticated = 16;  ///< Connections that have not sent Hello.
inline constexpr std::size_t kMostControllers = 4;       ///< Clients that request control; one of them has it.
inline constexpr std::size_t kMostWatchers = 8;          ///< Clients that do not request control.
inline constexpr double kMostAcceptedPerS = 100.0;
inline constexpr double kMostAcceptedAtOnce = 16.0;
inline constexpr double kMostRefusalsPerS = 10.0;  ///< Refusals of invalid messages, for one connection.
inline constexpr double kMostRefusalsAtOnce = 10.0;
inline constexpr double kHelloPatience_s = 5.0;  ///< A connection without a valid Hello is closed after this time.

}  // namespace trocar::link
