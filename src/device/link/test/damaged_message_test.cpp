// Bytes that were damaged on the way, or never were a message.
#include <gtest/gtest.h>

#include "link/codec.h"
#include "link/test/fingerprint.h"
#include "link/test/invariants.h"
#include "link/test/random_message.h"

namespace trocar::link {
namespace {

Result<ClientMessage> decode(std::span<const std::byte> bytes, const ClientMessage&) {
  return decode_client_message(bytes);
}
Result<ServerMessage> decode(std::span<const std::byte> bytes, const ServerMessage&) {
  return decode_server_message(bytes);
}

/// Refused, or good in every respect: then it comes through the codec once more as it is.
template <class Message>
void expect_refused_or_valid(const Result<Message>& decoded) {
  if (!decoded) {
    EXPECT_FALSE(decoded.error().what.empty());
    return;
  }
  EXPECT_EQ(find_broken_invariant(*decoded), "");
  const auto again = decode(encode(*decoded), *decoded);
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(Fingerprint(*again), Fingerprint(*decoded));
}

template <class Message>
void cut_everywhere(const Message& message) {
  // What a message ends in may be padding: without it the rest is the same message.
  constexpr std::size_t kMostPadding = 8;
  const Bytes bytes = encode(message);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto decoded = decode(std::span(bytes).first(size), message);
    if (!decoded) continue;
    EXPECT_GT(size + kMostPadding, bytes.size());
    EXPECT_EQ(Fingerprint(*decoded), Fingerprint(message));
  }
}

template <class Message>
void flip_everywhere(const Message& message) {
  Bytes bytes = encode(message);
  int accepted = 0;
  for (std::byte& byte : bytes) {
    const std::byte before = byte;
    for (const unsigned mask : {0x01u, 0x02u, 0x04u, 0x08u, 0x10u, 0x20u, 0x40u, 0x80u, 0xFFu}) {
      byte = before ^ std::byte(mask);
      const auto decoded = decode(bytes, message);
      accepted += decoded.has_value();
      expect_refused_or_valid(decoded);
    }
    byte = before;
  }
  EXPECT_GT(accepted, 0) << "a number's last bits may change";
}

TEST(DamagedMessage, IsRefusedWhenTruncatedAnywhere) {
  RandomMessages random(11);
  for (const ClientMessage& message : random.client_messages()) cut_everywhere(message);
  for (const ServerMessage& message : random.server_messages()) cut_everywhere(message);
}

TEST(DamagedMessage, IsRefusedOrValidWithAFlippedByte) {
  RandomMessages random(12);
  for (const ClientMessage& message : random.client_messages()) flip_everywhere(message);
  for (const ServerMessage& message : random.server_messages()) flip_everywhere(message);
}

TEST(DamagedMessage, IsRefusedOrValidWithSeveralWrongBytes) {
  Random random(13);
  constexpr int kTrials = 3000;
  for (int trial = 0; trial < kTrials; ++trial) {
    RandomMessages messages(random.next());
    Bytes bytes = trial % 2 == 0 ? encode(messages.client_message()) : encode(messages.server_message());
    for (int i = 0; i < 4; ++i) bytes[random.next() % bytes.size()] = std::byte(random.next() & 0xFF);
    expect_refused_or_valid(decode_client_message(bytes));
    expect_refused_or_valid(decode_server_message(bytes));
  }
}

TEST(DamagedMessage, NoiseIsRefused) {
  constexpr std::size_t kNoiseBytes = 64 * 1024;
  constexpr std::size_t kRootOffset = 16;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    Bytes noise(kNoiseBytes);
    for (std::byte& byte : noise) byte = std::byte(random.next() & 0xFF);
    EXPECT_FALSE(decode_client_message(noise));
    EXPECT_FALSE(decode_server_message(noise));
    // The same behind a good beginning.
    const Bytes good = encode(ClientMessage{1, 1, Goodbye{}});
    std::copy_n(good.begin(), kRootOffset, noise.begin());
    expect_refused_or_valid(decode_client_message(noise));
  }
}

TEST(DamagedMessage, EmptyAndTinyAreRefused) {
  for (std::size_t size = 0; size < 32; ++size) {
    for (const int fill : {0x00, 0xFF}) {
      const Bytes bytes(size, std::byte(fill));
      EXPECT_FALSE(decode_client_message(bytes));
      EXPECT_FALSE(decode_server_message(bytes));
    }
  }
}

TEST(DamagedMessage, IsRefusedBySizeWhenTooLarge) {
  Bytes bytes = encode(ClientMessage{1, 1, Goodbye{}});
  bytes.resize(kMostMessageBytes);
  EXPECT_TRUE(decode_client_message(bytes));
  bytes.resize(kMostMessageBytes + 1);
  const auto decoded = decode_client_message(bytes);
  ASSERT_FALSE(decoded);
  EXPECT_NE(decoded.error().what.find("1048577"), std::string::npos) << decoded.error().what;
}

TEST(DamagedMessage, IsRefusedFromTheWrongSide) {
  RandomMessages random(14);
  for (const ClientMessage& message : random.client_messages()) EXPECT_FALSE(decode_server_message(encode(message)));
  for (const ServerMessage& message : random.server_messages()) EXPECT_FALSE(decode_client_message(encode(message)));
}

}  // namespace
}  // namespace trocar::link
