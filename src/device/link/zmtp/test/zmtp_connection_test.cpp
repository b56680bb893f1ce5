// The server's side of a connection, without sockets: bytes in, events out.
#include "link/zmtp/detail/zmtp_connection.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "link/messages.h"

namespace trocar::link::detail {
namespace {

using Event = ZmtpConnection::Event;
constexpr double kReceived_s = 5.0;

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

std::vector<std::byte> handshake(std::string_view socket_type = "DEALER", std::string_view mechanism = "NULL") {
  std::vector<std::byte> bytes = zmtp::make_greeting(mechanism, false);
  std::vector<std::byte> ready;
  append_bytes(ready, bytes_of("\x05READY"));
  append_bytes(ready, zmtp::make_metadata(socket_type));
  zmtp::append_frame(bytes, zmtp::kCommand, ready);
  return bytes;
}
/// The handshake of a DEALER with an identity.
std::vector<std::byte> handshake_as(const std::string& identity) {
  std::vector<std::byte> bytes = zmtp::make_greeting("NULL", false), ready;
  append_bytes(ready, bytes_of("\x05READY\x0bSocket-Type"));
  append_bytes(ready, bytes_of(std::string_view("\0\0\0\x06"
                                                "DEALER"
                                                "\x08Identity\0\0",
                                                21)));
  ready.push_back(static_cast<std::byte>(identity.size() >> 8));
  ready.push_back(static_cast<std::byte>(identity.size()));
  append_bytes(ready, bytes_of(identity));
  zmtp::append_frame(bytes, zmtp::kCommand, ready);
  return bytes;
}
std::vector<std::byte> frame(std::uint8_t flags, std::size_t size) {
  std::vector<std::byte> bytes;
  zmtp::append_frame(bytes, flags, std::vector<std::byte>(size, std::byte{7}));
  return bytes;
}

/// The next event after the handshake's.
ZmtpConnection::Incoming next(ZmtpConnection& connection, double now_s = kReceived_s) {
  const auto incoming = connection.next(now_s);
  return incoming.event == Event::kReady ? connection.next(now_s) : incoming;
}

TEST(ZmtpConnection, ParsesHandshakeAndMessagesInAnyPieces) {
  for (const std::size_t piece : {1u, 3u, 64u, 1000u}) {
    ZmtpConnection connection(nullptr);
    std::vector<std::byte> bytes = handshake();
    append_bytes(bytes, frame(0, 5));
    append_bytes(bytes, frame(0, 300));
    std::vector<std::size_t> sizes;
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
      connection.append(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)));
      while (true) {
        const auto incoming = next(connection);
        if (incoming.event == Event::kNone) break;
        ASSERT_EQ(incoming.event, Event::kMessage);
        sizes.push_back(incoming.message.size());
      }
    }
    EXPECT_EQ(sizes, (std::vector<std::size_t>{5, 300})) << "in pieces of " << piece;
    EXPECT_TRUE(connection.is_ready());
    // Greeting and READY.
    EXPECT_GT(connection.outgoing().size(), zmtp::kGreetingBytes);
  }
}

TEST(ZmtpConnection, ClosesNonZmtp3Dealers) {
  std::vector<std::byte> old = handshake();
  old[10] = std::byte{1};
  for (const auto& bytes : {old, handshake("DEALER", "CURVE"), handshake("REQ"), std::vector<std::byte>(64),
                            std::vector<std::byte>(1000, std::byte{0xFF})}) {
    ZmtpConnection connection(nullptr);
    connection.append(bytes);
    EXPECT_EQ(next(connection).event, Event::kBroken);
    EXPECT_FALSE(connection.why().empty());
    EXPECT_EQ(connection.room(kReceived_s), 0u);
  }
}

TEST(ZmtpConnection, SkipsAMultipartMessage) {
  ZmtpConnection connection(nullptr);
  connection.append(handshake());
  connection.append(frame(zmtp::kMore, 3));
  connection.append(frame(zmtp::kMore, 3));
  connection.append(frame(0, 3));
  connection.append(frame(0, 9));
  EXPECT_EQ(next(connection).event, Event::kMultipart);
  const auto good = next(connection);
  EXPECT_EQ(good.event, Event::kMessage);
  EXPECT_EQ(good.message.size(), 9u);
}

TEST(ZmtpConnection, DisconnectsOnAnEndlessMultipart) {
  ZmtpConnection connection(nullptr);
  connection.set_greeted(true);
  connection.append(handshake());
  int frames = 0;
  Event event = Event::kNone;
  for (; event != Event::kBroken && frames < 1000; ++frames) {
    connection.append(frame(zmtp::kMore, 0));
    event = next(connection).event;
  }
  EXPECT_LT(frames, 100);
  EXPECT_EQ(event, Event::kBroken);
}

TEST(ZmtpConnection, LimitsMessagesBeforeHello) {
  ZmtpConnection stranger(nullptr), greeted(nullptr);
  greeted.set_greeted(true);
  for (ZmtpConnection* connection : {&stranger, &greeted}) {
    connection->append(handshake());
    connection->append(frame(0, kMostBytesBeforeHello));
    EXPECT_EQ(next(*connection).event, Event::kMessage);
    connection->append(frame(0, kMostBytesBeforeHello + 1));
  }
  EXPECT_EQ(next(stranger).event, Event::kBroken);
  EXPECT_EQ(next(greeted).event, Event::kMessage);
}

TEST(ZmtpConnection, SumsTheFramesOfAMessageBeforeHello) {
  for (const std::size_t last : {1u, 2u}) {
    ZmtpConnection connection(nullptr);
    connection.append(handshake());
    connection.append(frame(zmtp::kMore, kMostBytesBeforeHello - 1));
    EXPECT_EQ(next(connection).event, Event::kMultipart);
    connection.append(frame(0, last));
    EXPECT_EQ(next(connection).event, last == 1 ? Event::kNone : Event::kBroken);
  }
}

TEST(ZmtpConnection, SkipsOversizedMessagesAndDisconnectsBeyondTwice) {
  const auto event_of = [](std::size_t size) {
    ZmtpConnection connection(nullptr);
    connection.set_greeted(true);
    connection.append(handshake());
    connection.append(frame(0, size));
    return next(connection).event;
  };
  EXPECT_EQ(event_of(kMostMessageBytes), Event::kMessage);
  EXPECT_EQ(event_of(kMostMessageBytes + 1), Event::kTooLarge);
  EXPECT_EQ(event_of(2 * kMostMessageBytes), Event::kTooLarge);
  EXPECT_EQ(event_of(2 * kMostMessageBytes + 1), Event::kBroken);
}

TEST(ZmtpConnection, DisconnectsBeyond64FramesOrTwoMebibytes) {
  const auto last_event = [](std::size_t frames, std::size_t size) {
    ZmtpConnection connection(nullptr);
    connection.set_greeted(true);
    connection.append(handshake());
    Event event = Event::kNone;
    for (std::size_t n = 0; n < frames; ++n) {
      connection.append(frame(zmtp::kMore, size));
      event = next(connection).event;
    }
    return event;
  };
  EXPECT_EQ(last_event(64, 1), Event::kNone);
  EXPECT_EQ(last_event(65, 1), Event::kBroken);
  EXPECT_EQ(last_event(32, kMostMessageBytes / 16), Event::kNone);
  EXPECT_EQ(last_event(33, kMostMessageBytes / 16), Event::kBroken);
}

TEST(ZmtpConnection, LimitsAnIdentityTo255BytesWithoutLeadingZero) {
  const auto event_of = [](const std::string& identity) {
    ZmtpConnection connection(nullptr);
    connection.append(handshake_as(identity));
    const Event event = connection.next(kReceived_s).event;
    if (event == Event::kReady) {
      EXPECT_EQ(connection.identity(), identity);
    }
    return event;
  };
  EXPECT_EQ(event_of(""), Event::kReady);
  EXPECT_EQ(event_of("a"), Event::kReady);
  EXPECT_EQ(event_of(std::string("a\0b", 3)), Event::kReady);
  EXPECT_EQ(event_of(std::string(255, 'a')), Event::kReady);
  EXPECT_EQ(event_of(std::string(256, 'a')), Event::kBroken);
  EXPECT_EQ(event_of(std::string(1, '\0')), Event::kBroken);
  EXPECT_EQ(event_of(std::string("\0connection 1", 13)), Event::kBroken);
}

TEST(ZmtpConnection, DisconnectsAtTheHeaderOfATooLongFrame) {
  ZmtpConnection connection(nullptr);
  connection.set_greeted(true);
  connection.append(handshake());
  const std::vector<std::byte> whole = frame(0, 2 * kMostMessageBytes + 1);
  connection.append(std::span(whole).first(9));
  EXPECT_EQ(next(connection).event, Event::kBroken);
}

TEST(ZmtpConnection, RateLimitThrottlesAFlood) {
  ZmtpConnection connection(nullptr);
  connection.set_greeted(true);
  connection.append(handshake());
  std::size_t taken = 0;
  const auto take_all = [&](double now_s) {
    while (next(connection, now_s).event == Event::kMessage) ++taken;
  };
  for (int i = 0; i < 20'000; ++i) connection.append(frame(0, 2));
  take_all(kReceived_s);
  EXPECT_LE(taken, static_cast<std::size_t>(kMostMessagesAtOnce));
  EXPECT_EQ(connection.room(kReceived_s), 0u);
  take_all(kReceived_s + 1.0);
  EXPECT_LE(taken, static_cast<std::size_t>(kMostMessagesAtOnce + kMostMessagesPerS));
  EXPECT_GT(taken, static_cast<std::size_t>(kMostMessagesAtOnce));
}

TEST(ZmtpConnection, BytesBeyondTheRateAreNotRead) {
  ZmtpConnection connection(nullptr);
  connection.set_greeted(true);
  connection.append(handshake());
  std::size_t read = 0;
  for (std::size_t room = 0; (room = connection.room(kReceived_s)) > 0; read += room) {
    connection.append(std::vector<std::byte>(room, std::byte{0}));  // empty frames
    while (next(connection).event == Event::kMessage) {
    }
    ASSERT_LT(read, 100u << 20);
  }
  EXPECT_LE(static_cast<double>(read), kMostBytesAtOnce + 64.0 * 1024);
}

TEST(ZmtpConnection, OutputIsBounded) {
  ZmtpConnection connection(nullptr);
  connection.append(handshake());
  next(connection);
  const std::vector<std::byte> message(100'000);
  int put = 0;
  while (connection.put(message)) ASSERT_LT(++put, 1000);
  EXPECT_LE(connection.outgoing().size(), kMostBytesOut);
  const std::size_t waiting = connection.outgoing().size();
  connection.note_sent(waiting);
  EXPECT_TRUE(connection.outgoing().empty());
  EXPECT_TRUE(connection.put(message));
}

TEST(ZmtpConnection, AnswersAPing) {
  ZmtpConnection connection(nullptr);
  connection.append(handshake());
  next(connection);
  connection.note_sent(connection.outgoing().size());
  std::vector<std::byte> ping;
  zmtp::append_frame(ping, zmtp::kCommand, bytes_of(std::string_view("\x04PING\0\0abc", 10)));
  connection.append(ping);
  EXPECT_EQ(next(connection).event, Event::kNone);
  std::vector<std::byte> pong;
  zmtp::append_frame(pong, zmtp::kCommand, bytes_of("\x04PONGabc"));
  EXPECT_TRUE(std::ranges::equal(connection.outgoing(), pong));
}

TEST(ZmtpConnection, RandomBytesNeitherCrashNorGrow) {
  Random random(11);
  const CurveKeys keys = *make_curve_keys();
  const auto identity = CurveIdentity::make(keys, {});
  ASSERT_TRUE(identity);
  for (int round = 0; round < 300; ++round) {
    const bool has_keys = round % 2 == 1;
    ZmtpConnection connection(has_keys ? &*identity : nullptr);
    connection.append(has_keys ? zmtp::make_greeting("CURVE", false) : handshake());
    for (int i = 0; i < 20; ++i) {
      std::vector<std::byte> bytes(random.next() % 4096);
      for (std::byte& byte : bytes) byte = static_cast<std::byte>(random.next() % (i % 2 == 0 ? 256 : 8));
      connection.append(bytes);
      for (int k = 0; k < 1000; ++k) {
        const Event event = next(connection).event;
        if (event == Event::kNone || event == Event::kBroken) break;
      }
      EXPECT_LE(connection.outgoing().size(), kMostBytesOut);
    }
  }
}

}  // namespace
}  // namespace trocar::link::detail
