#pragma once

#include <cstddef>

/// Limits of a server for its clients. docs/link.md lists these numbers for other implementations.
namespace trocar::link {

inline constexpr std::size_t kMostMessageBytes = 1 << 20;  ///< Larger ones are dropped unread.
inline constexpr std::size_t kMostTextBytes = 256 * 1024;  ///< Of one string (a tissue table is the longest).
inline constexpr std::size_t kMostNameBytes = 256;         ///< Of a client's name in Hello.
inline constexpr std::size_t kMostBytesBeforeHello = 4096;

// Rates of one connection, before and after Hello. A peer beyond them is read more slowly. [assumed]
inline constexpr double kMostMessagesPerS = 4000.0;  ///< Above 1 kHz of hands, heartbeats and commands.
inline constexpr double kMostMessagesAtOnce = 1000.0;
inline constexpr double kMostBytesPerS = 4.0 * 1024 * 1024;
inline constexpr double kMostBytesAtOnce = 4.0 * 1024 * 1024;
/// Waiting for a client to read them; batches beyond are dropped for it [assumed: two seconds at 1 kHz].
inline constexpr std::size_t kMostBytesOut = 1280 * 1024;
/// In addition, for replies to commands, which are never dropped; a client that does not even read these is removed.
inline constexpr std::size_t kMostReplyBytesOut = 1 << 20;

// Connections and clients. [assumed]
inline constexpr std::size_t kMostStrangers = 16;   ///< Connections that have not said Hello.
inline constexpr std::size_t kMostControllers = 4;  ///< Clients that want control: one has it.
inline constexpr std::size_t kMostWatchers = 8;     ///< Clients that do not.
inline constexpr double kMostAcceptedPerS = 100.0;
inline constexpr double kMostAcceptedAtOnce = 16.0;
inline constexpr double kMostRefusalsPerS = 10.0;  ///< Of one connection: answers to bad messages.
inline constexpr double kMostRefusalsAtOnce = 10.0;
inline constexpr double kMostLogLinesPerS = 1.0 / 6.0;  ///< Of all connections.
inline constexpr double kMostLogLinesAtOnce = 10.0;
inline constexpr double kHelloPatience_s = 5.0;  ///< A connection without a good Hello is closed after it.

}  // namespace trocar::link
